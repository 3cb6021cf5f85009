"use strict";

/* ---- numbers.js: arrays from base64, and doubles as swiftprox-replay prints them ---- */

/* The bytes of a block of the page, which is then forgotten. */
function takeBytes(id) {
  const element = document.getElementById(id);
  const text = element.textContent;
  element.remove();
  if (Uint8Array.fromBase64) {
    return Uint8Array.fromBase64(text);
  }
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; i++) {
    bytes[i] = letters.charCodeAt(i);
  }
  return bytes;
}

/* Typed arrays have the machine's order of bytes: the lowest first wherever a browser runs. */
function takeArray(id, Type) {
  const bytes = takeBytes(id);
  return new Type(bytes.buffer, bytes.byteOffset, bytes.byteLength / Type.BYTES_PER_ELEMENT);
}

/* A finite double that is not 0 as its digits and the power of ten of the first, all of them. */
function exactDigits(magnitude) {
  const view = new DataView(new ArrayBuffer(8));
  view.setFloat64(0, magnitude);
  const bits = view.getBigUint64(0);
  const biased = Number(bits >> 52n);
  const fraction = bits & 0xfffffffffffffn;
  const mantissa = biased === 0 ? fraction : fraction | 0x10000000000000n;
  const exponent = Math.max(biased, 1) - 1075;
  const digits = (exponent < 0 ? mantissa * 5n ** BigInt(-exponent) : mantissa << BigInt(exponent)).toString();
  return { digits, power: digits.length - 1 + Math.min(exponent, 0) };
}

/* Whether the digits kept go up by one: `direction` is -1 for a lower end, 1 for an upper, 0 for the nearest, ties to even. */
function goesUp(kept, rest, direction, isNegative) {
  if (/^0*$/.test(rest)) {
    return false;
  }
  if (direction !== 0) {
    return (direction > 0) !== isNegative;
  }
  const half = "5".padEnd(rest.length, "0");
  return rest > half || (rest === half && Number(kept[kept.length - 1]) % 2 === 1);
}

/* As printf("%.17g") with the rounding of that direction. */
function printed(value, direction = 0) {
  const DIGITS = 17;
  if (Number.isNaN(value)) {
    return "nan";
  }
  const isNegative = value < 0 || Object.is(value, -0);
  const sign = isNegative ? "-" : "";
  if (!Number.isFinite(value)) {
    return sign + "inf";
  }
  if (value === 0) {
    return sign + "0";
  }
  let { digits, power } = exactDigits(Math.abs(value));
  const kept = digits.slice(0, DIGITS);
  if (goesUp(kept, digits.slice(DIGITS), direction, isNegative)) {
    digits = (BigInt(kept) + 1n).toString();
    power += digits.length - kept.length;
  } else {
    digits = kept;
  }
  digits = digits.replace(/0+$/, "");
  if (power < -4 || power >= DIGITS) {
    const point = digits.length > 1 ? "." : "";
    const size = String(Math.abs(power)).padStart(2, "0");
    return sign + digits[0] + point + digits.slice(1) + "e" + (power < 0 ? "-" : "+") + size;
  }
  if (power < 0) {
    return sign + "0." + "0".repeat(-power - 1) + digits;
  }
  const whole = digits.slice(0, power + 1).padEnd(power + 1, "0");
  const fraction = digits.slice(power + 1);
  return sign + whole + (fraction ? "." + fraction : "");
}

/* A number at a glance. */
function shortly(value, digits = 4) {
  if (!Number.isFinite(value)) {
    return printed(value);
  }
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) {
    return value.toExponential(digits - 2).replace(/\.?0+e/, "e").replaceAll("-", "−");
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

/* Whole numbers with their thousands apart. */
function counted(number, noun) {
  return number.toLocaleString("en") + (noun ? " " + noun + (number === 1 ? "" : "s") : "");
}
