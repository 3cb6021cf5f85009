//! Scripts for Gappa and Coq, made of the tapes.

use std::collections::BTreeMap;
use std::fmt::Write;

use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

use crate::count::{Counter, Polynomial, WIDE_PRODUCT, WIDE_SUM, rational, unit_roundoff};
use crate::kernels::{Kernel, Value, named};
use crate::library::{RIGID, RIGID_DEFECT, RIGID_TOGETHER};
use crate::tape::{Node, Op, Tape, dyadic};

/// A file's name and its text.
pub type Script = (String, String);

/// All scripts.
pub fn scripts(kernels: &[Kernel]) -> Vec<Script> {
    let counted = kernels.iter().filter(|kernel| !kernel.values.is_empty());
    let coefficients = counted.map(|kernel| (format!("{}.g", kernel.name), coefficients(kernel)));
    let mut all: Vec<Script> = coefficients.collect();
    all.extend(roundings(kernels));
    all.push(("identities.v".into(), identities(kernels)));
    all.push(("constants.v".into(), constants(kernels)));
    all.push(("words.v".into(), words(named(kernels, "double_double"))));
    all
}

/// A bound of a rational as a multiple of a power of two, for Gappa: of what is given a finer one than of what is to be proved.
fn outward(x: &RBig, is_upper: bool, exponent: usize) -> String {
    let scaled = x * RBig::from(IBig::ONE << exponent);
    let whole = if is_upper { scaled.ceil() } else { scaled.floor() };
    format!("{whole}b-{exponent}")
}

/// That each coefficient of each value is in its interval, whatever the errors are.
fn coefficients(kernel: &Kernel) -> String {
    let (mut definitions, mut given, mut goals) = (String::new(), BTreeMap::new(), Vec::new());
    let mut done = std::collections::BTreeSet::new();
    for Value { node, cuts, .. } in &kernel.values {
        let mut counter = Counter::new(&kernel.tape, cuts.clone());
        let polynomial = counter.count(*node);
        for (node, _, [low, high]) in &counter.roots {
            given.insert(format!("f{node}"), format!("[{}, {}]", outward(low, false, 160), outward(high, true, 160)));
        }
        for below in kernel.tape.below(&[*node], cuts) {
            match kernel.tape.op(below) {
                _ if cuts.contains_key(&below) => {}
                Op::Constant => {
                    let line = format!("c{below} = {};", dyadic(kernel.tape.value(below)));
                    if !definitions.contains(&line) {
                        writeln!(definitions, "{line}").expect("a string");
                    }
                }
                Op::Input | Op::Neg | Op::Abs => {}
                _ => drop(given.insert(format!("e{below}"), "[-1b-53, 1b-53]".to_string())),
            }
        }
        for coefficient in polynomial.values().filter(|c| c.text.contains('e')) {
            if done.insert(coefficient.text.clone()) {
                let [low, high] = [outward(&coefficient.low, false, 130), outward(&coefficient.high, true, 130)];
                goals.push(format!("{} in [{low}, {high}]", coefficient.text));
            }
        }
    }
    let given: Vec<String> = given.iter().map(|(name, range)| format!("{name} in {range}")).collect();
    format!(
        "# The coefficients of values on {}.tape.\n{definitions}{{ {}\n  -> {} }}\n",
        kernel.name,
        given.join(" /\\ "),
        goals.join(" /\\\n     ")
    )
}

/// What a node is in a script where each operation rounds to a double, subnormal or not, and its exact twin in capitals.
struct Rounded {
    text: String,
    words: BTreeMap<Node, [String; 2]>,
}

fn with_roundings(tape: &Tape, root: Node, twin: impl Fn(f64) -> String) -> Rounded {
    let mut rounded = Rounded { text: "@rnd = float<ieee_64, ne>;\n".into(), words: BTreeMap::new() };
    for node in tape.below(&[root], &BTreeMap::new()) {
        let words: Vec<[String; 2]> = tape.operands(node).iter().map(|node| rounded.words[node].clone()).collect();
        let formula = |k: usize| {
            let word = |at: usize| words[at][k].as_str();
            match tape.op(node) {
                Op::Add => format!("{} + {}", word(0), word(1)),
                Op::Sub => format!("{} - {}", word(0), word(1)),
                Op::Mul => format!("{} * {}", word(0), word(1)),
                Op::Fma => format!("{} * {} + {}", word(0), word(1), word(2)),
                op => panic!("{op:?} in a script of roundings"),
            }
        };
        let number = rounded.words.len();
        let words = match tape.op(node) {
            Op::Input => {
                let name = tape.name(node);
                writeln!(rounded.text, "{name} = rnd({name}_);").expect("a string");
                [name.to_string(), name.to_string()]
            }
            Op::Constant => [dyadic(tape.value(node)), twin(tape.value(node))],
            _ => {
                writeln!(rounded.text, "t{number} = rnd({});\nT{number} = {};", formula(0), formula(1))
                    .expect("a string");
                [format!("t{number}"), format!("T{number}")]
            }
        };
        rounded.words.insert(node, words);
    }
    rounded
}

/// 1/k! where a constant is that, rounded.
fn of_taylor(x: f64) -> String {
    let mut factorial = 1u64;
    for k in 2..19 {
        factorial *= k;
        if (x.abs() * factorial as f64 - 1.0).abs() < 1e-15 {
            return format!("({}1/{factorial})", if x < 0.0 { "-" } else { "" });
        }
    }
    dyadic(x)
}

/// Sine and cosine, and entries of RᵀR − I.
fn roundings(kernels: &[Kernel]) -> Vec<Script> {
    let root = |kernel: &str, name: &str| {
        let kernel = named(kernels, kernel);
        let root = kernel.roots.iter().find(|(own, _)| own == name).unwrap_or_else(|| panic!("no {name}"));
        (&kernel.tape, root.1)
    };
    let mut all = Vec::new();
    // Taylor's series breaks off below 2⁻⁶³.
    for (name, bound) in [("sine", "1b-53"), ("cosine", "5b-55")] {
        let (tape, node) = root("turn", name);
        let Rounded { text, words } = with_roundings(tape, node, of_taylor);
        let [own, exact] = &words[&node];
        all.push((
            format!("{name}.g"),
            format!("{text}{{ r in [-0.7854, 0.7854] -> |{own} - {exact}| <= {bound} }}\n"),
        ));
    }
    let (tape, node) = root("turn", "reduced");
    let Rounded { text, words } = with_roundings(tape, node, dyadic);
    // The products with 33 bits of π/2 are exact, the first difference too, the others are rounded.
    let text = text.replace("multiple = rnd(multiple_);", "@whole = fixed<0, ne>;\nmultiple = whole(multiple_);");
    let mut at = node;
    let mut given = vec!["angle in [0.5, 1048576]".to_string(), "multiple in [0, 667545]".to_string()];
    while tape.op(at) == Op::Sub {
        let [before, product] = [0, 1].map(|k| tape.operands(at)[k]);
        let factor = &words[&tape.operands(product)[1]][0];
        given.push(format!("{} - multiple * {factor} in [-0.7854, 0.7854]", words[&before][0]));
        at = before;
    }
    let [own, exact] = &words[&node];
    all.push((
        "reduced.g".into(),
        format!("{text}{{ {} -> {own} - {exact} in [-1b-53, 1b-53] }}\n", given.join(" /\\ ")),
    ));
    for (kernel, entry, most) in [
        ("rigid_fused", "square1", "1025b-63"),
        ("rigid_fused", "product1", "1026b-63"),
        ("rigid_plain", "square1", "2561b-63"),
        ("rigid_plain", "product1", "2052b-63"),
        ("pose", "square", "3585b-63"),
        ("pose", "product", "2052b-63"),
    ] {
        let (tape, node) = root(kernel, entry);
        let is_square = entry.starts_with("square");
        // No square is over 1, or one is, and the others are next to nothing.
        for over in [None, Some(0), Some(1), Some(2)].into_iter().take(if is_square { 4 } else { 1 }) {
            let name = over.map_or_else(String::new, |k: usize| format!("_{k}"));
            all.push((format!("{kernel}_{entry}{name}.g"), entry_of_defect(tape, node, is_square, over, most)));
        }
    }
    all
}

/// An entry of RᵀR − I as computed, for columns of length 1 and products of 0 up to 2⁻⁴⁰.
fn entry_of_defect(tape: &Tape, root: Node, is_square: bool, over: Option<usize>, most: &str) -> String {
    let Rounded { text, words } = with_roundings(tape, root, dyadic);
    let (mut given, mut products) = (Vec::new(), 0);
    for (node, [_, exact]) in &words {
        let operands: Vec<&str> = tape.operands(*node).iter().map(|node| words[node][1].as_str()).collect();
        let below = tape.below(&[*node], &BTreeMap::new());
        if matches!(tape.op(*node), Op::Mul | Op::Fma) {
            let range = match over {
                _ if !is_square => "[-0.501, 0.501]",
                None => "[0, 1]",
                Some(k) if k == products => "[1, 1.000000000001]",
                Some(_) => "[0, 1b-39]",
            };
            products += 1;
            given.push(format!("{} * {} in {range}", operands[0], operands[1]));
        }
        let range = match tape.op(*node) {
            Op::Fma | Op::Add | Op::Sub if *node == root => "[-1b-40, 1b-40]",
            Op::Fma | Op::Add if !is_square => "[-0.501, 0.501]",
            Op::Fma | Op::Add if over.is_none() => {
                let takes_one_off = below.iter().any(|node| tape.op(*node) == Op::Constant);
                let squares = below.iter().filter(|node| matches!(tape.op(**node), Op::Mul | Op::Fma)).count();
                match (takes_one_off, squares) {
                    (true, 1) => "[-1, 0]",
                    (true, _) => "[-1, 1b-40]",
                    (false, 3) => "[0.99, 1.01]",
                    (false, _) => "[0, 1]",
                }
            }
            _ => continue,
        };
        given.push(format!("{exact} in {range}"));
    }
    let [own, exact] = &words[&root];
    format!("{text}{{ {}\n  -> {own} - {exact} in [-{most}, {most}] }}\n", given.join(" /\\ "))
}

fn word(name: &str) -> String {
    name.replace(['|', '/'], "_")
}

/// That each value is the polynomial that is counted.
fn identities(kernels: &[Kernel]) -> String {
    let mut text = String::from("Require Import Reals.\nOpen Scope R_scope.\n");
    for kernel in kernels {
        for Value { name, node, cuts } in &kernel.values {
            let below = kernel.tape.below(&[*node], cuts);
            // Magnitudes are products of magnitudes.
            if below.iter().any(|node| !cuts.contains_key(node) && kernel.tape.op(*node) == Op::Abs) {
                continue;
            }
            let mut counter = Counter::new(&kernel.tape, cuts.clone());
            let polynomial = counter.count(*node);
            let roots: BTreeMap<Node, String> =
                counter.roots.iter().map(|(node, name, _)| (*node, word(name))).collect();
            identity(&mut text, kernel, name, *node, &mut counter, &polynomial, &roots);
        }
    }
    text
}

fn identity(
    text: &mut String,
    kernel: &Kernel,
    name: &str,
    root: Node,
    counter: &mut Counter,
    polynomial: &Polynomial,
    roots: &BTreeMap<Node, String>,
) {
    let (tape, cuts) = (&kernel.tape, &counter.cuts.clone());
    let (mut variables, mut not_zero) = (std::collections::BTreeSet::new(), Vec::new());
    let mut expressions: BTreeMap<Node, String> = BTreeMap::new();
    // Below a root everything is in the root's name and factor.
    let ends: BTreeMap<Node, String> = cuts.iter().chain(roots).map(|(node, name)| (*node, name.clone())).collect();
    let mut is_quotient = false;
    for node in tape.below(&[root], &ends) {
        let operand = |k: usize| expressions[&tape.operands(node)[k]].clone();
        let rounded = |formula: String| format!("({formula}) * (1 + e{node})");
        let expression = if let Some(name) = cuts.get(&node) {
            variables.insert(word(name));
            word(name)
        } else if let Some(name) = roots.get(&node) {
            variables.extend([name.clone(), format!("f{node}"), format!("e{node}")]);
            not_zero.extend([name.clone(), format!("f{node}"), format!("1 + e{node}")]);
            format!("{name} * f{node} * (1 + e{node})")
        } else {
            match tape.op(node) {
                Op::Input => {
                    variables.insert(word(tape.name(node)));
                    word(tape.name(node))
                }
                Op::Constant if tape.value(node) == 0.0 => "0".to_string(),
                Op::Constant => {
                    variables.insert(format!("c{node}"));
                    format!("c{node}")
                }
                Op::Neg => format!("(- ({}))", operand(0)),
                op => {
                    let is_exact = op == Op::Mul
                        && tape.operands(node).iter().any(|node| {
                            tape.op(*node) == Op::Constant
                                && crate::tape::parts(tape.value(*node)).0.unsigned_abs().is_power_of_two()
                        });
                    let formula = match op {
                        Op::Add => format!("{} + {}", operand(0), operand(1)),
                        Op::Sub => format!("{} - ({})", operand(0), operand(1)),
                        Op::Mul => format!("({}) * ({})", operand(0), operand(1)),
                        Op::Fma => format!("({}) * ({}) + {}", operand(0), operand(1), operand(2)),
                        Op::Fnma => format!("{} - ({}) * ({})", operand(2), operand(0), operand(1)),
                        Op::Div => {
                            is_quotient = true;
                            let divisor = counter.count(tape.operands(node)[1]);
                            let constants = tape.below(&[tape.operands(node)[1]], &ends).into_iter();
                            let constants = constants.filter(|node| tape.op(*node) == Op::Constant);
                            not_zero.extend(constants.map(|node| format!("c{node}")));
                            not_zero.extend(divisor.keys().flatten().map(|name| word(name.trim_start_matches('/'))));
                            format!("({}) / ({})", operand(0), operand(1))
                        }
                        op => panic!("{op:?} in an identity"),
                    };
                    if is_exact {
                        format!("({formula})")
                    } else {
                        variables.insert(format!("e{node}"));
                        rounded(formula)
                    }
                }
            }
        };
        expressions.insert(node, expression);
    }
    let inverse = |name: &String| name.strip_prefix('/').map_or_else(|| word(name), |name| format!("/ {}", word(name)));
    let terms: Vec<String> = polynomial
        .iter()
        .map(|(monomial, c)| {
            std::iter::once(format!("({})", c.text)).chain(monomial.iter().map(inverse)).collect::<Vec<_>>().join(" * ")
        })
        .collect();
    let mut conditions = String::new();
    if is_quotient {
        not_zero.extend(polynomial.keys().flatten().filter_map(|name| name.strip_prefix('/').map(word)));
        not_zero.sort();
        not_zero.dedup();
        not_zero.iter().for_each(|x| conditions += &format!("{x} <> 0 -> "));
    }
    let variables: Vec<String> = variables.into_iter().collect();
    writeln!(
        text,
        "Lemma {}_{name} : forall {} : R, {conditions}\n  {} =\n  {}.\nProof. intros; {}. Qed.",
        kernel.name,
        variables.join(" "),
        expressions[&root],
        terms.join("\n  + "),
        if is_quotient { "field; repeat split; assumption" } else { "ring" }
    )
    .expect("a string");
}

/// The numbers that `coq/assembly.v` is about: ends of coefficients, and constants of the code.
fn constants(kernels: &[Kernel]) -> String {
    let mut text = String::from("Require Import Reals.\nOpen Scope R_scope.\n");
    let mut define = |name: &str, x: &RBig| {
        let (numerator, denominator) = (x.numerator().clone(), IBig::from(UBig::clone(x.denominator())));
        writeln!(text, "Definition {name} : R := {numerator} / {denominator}.").expect("a string");
    };
    define("u", &unit_roundoff());
    let ends = |kernel: &str, value: &str, monomial: &[&str]| {
        let polynomial = named(kernels, kernel).polynomial(value);
        let key: Vec<String> = monomial.iter().map(|name| name.to_string()).collect();
        let coefficient = &polynomial[&key];
        [coefficient.low.clone(), coefficient.high.clone()]
    };
    for (kernel, value, monomials) in [
        ("bounds", "difference_error", vec![vec!["size"], vec!["separation"], vec!["length"]]),
        ("interval", "lower", vec![vec!["projection"], vec!["excess"], vec!["error"], vec!["distance"]]),
        ("interval", "upper", vec![vec!["distance"], vec!["error"], vec!["point"]]),
        (
            "determinant_error",
            "bound",
            vec![vec!["L", "L", "L"], vec!["E", "L", "L"], vec!["E", "E", "L"], vec!["E", "E", "E"]],
        ),
        ("round_ends", "lower_of_segments", vec![vec!["least"], vec!["size"], vec!["separation"]]),
        ("round_ends", "upper_of_segments", vec![vec!["distance"], vec!["size"], vec!["separation"]]),
        ("balls", "difference_x", vec![vec!["p0"]]),
        ("balls", "square", vec![vec!["x", "x"]]),
        ("balls", "inner", vec![vec!["r1"]]),
        ("balls", "limit", vec![vec!["inner", "inner"]]),
    ] {
        for monomial in monomials {
            let [low, high] = ends(kernel, value, &monomial);
            let name = format!("{value}_{}", monomial.concat());
            define(&format!("{name}_low"), &low);
            define(&format!("{name}_high"), &high);
        }
    }
    // The worst of fused and plain: how far a coefficient is below or above ±1.
    for (name, kernel, values) in [
        ("turned", "difference", &["first0", "first1", "first2", "second0", "second1", "second2"][..]),
        ("offset", "difference", &["offset0", "offset1", "offset2"]),
        ("end", "round", &["tail1_0", "tail1_1", "tail1_2", "tail2_0", "tail2_1", "tail2_2"]),
        ("raised", "difference", &["separation"]),
        ("product", "certificate", &["projection"]),
        ("length", "certificate", &["distance"]),
        ("determinant", "enclosure", &["determinant0", "determinant1", "determinant2", "determinant3"]),
    ] {
        let mut span: Option<[RBig; 2]> = None;
        for form in ["fused", "plain"] {
            for value in values {
                for coefficient in named(kernels, &format!("{kernel}_{form}")).polynomial(value).values() {
                    let sign = if coefficient.exact < RBig::ZERO { -RBig::ONE } else { RBig::ONE };
                    let ends = [&coefficient.low * &sign - RBig::ONE, &coefficient.high * sign - RBig::ONE];
                    let [low, high] = if ends[0] <= ends[1] { ends } else { [ends[1].clone(), ends[0].clone()] };
                    span = Some(match span {
                        None => [low, high],
                        Some([a, b]) => [if low < a { low } else { a }, if high > b { high } else { b }],
                    });
                }
            }
        }
        let [low, high] = span.expect("a value");
        define(&format!("{name}_down"), &-low);
        define(&format!("{name}_up"), &high);
    }
    define("wide_sum", &rational(WIDE_SUM));
    define("wide_product", &rational(WIDE_PRODUCT));
    define("rigid_defect", &rational(RIGID_DEFECT));
    define("rigid_together", &rational(RIGID_TOGETHER));
    define("rigid", &rational(RIGID));
    text
}

/// The words of double-doubles as the code computes them, for `coq/double_double.v`.
fn words(kernel: &Kernel) -> String {
    let mut text = String::from("Require Import Reals.\nRequire Import model.\nOpen Scope R_scope.\n");
    for (name, root) in &kernel.roots {
        writeln!(text, "Definition {name} (ah al bh bl : R) : R :=").expect("a string");
        for node in kernel.tape.below(&[*root], &BTreeMap::new()) {
            let operand = |k: usize| {
                let node = kernel.tape.operands(node)[k];
                match kernel.tape.op(node) {
                    Op::Input => kernel.tape.name(node).to_string(),
                    Op::Constant => format!("{}", kernel.tape.value(node)),
                    _ => format!("t{node}"),
                }
            };
            let formula = match kernel.tape.op(node) {
                Op::Input | Op::Constant => continue,
                Op::Add => format!("rnd ({} + {})", operand(0), operand(1)),
                Op::Sub => format!("rnd ({} - {})", operand(0), operand(1)),
                Op::Mul => format!("rnd ({} * {})", operand(0), operand(1)),
                Op::Neg => format!("- {}", operand(0)),
                op => panic!("{op:?} of double-doubles"),
            };
            writeln!(text, "  let t{node} := {formula} in").expect("a string");
        }
        writeln!(text, "  t{root}.").expect("a string");
    }
    text
}
