"""A page in headless Chromium, by its DevTools protocol: as much of it as test_page.py needs, from Python's own library.

The environment's BROWSER is its path; without one it is looked for as chromium."""
import base64
import json
import os
import re
import socket
import struct
import subprocess
import tempfile
import zlib

TEXT, PONG = 1, 10
CLOSED, PING = 8, 9


class Socket:
    """A WebSocket (RFC 6455) to this machine."""

    def __init__(self, port, path):
        self.stream = socket.create_connection(("127.0.0.1", port), timeout=60)
        key = base64.b64encode(os.urandom(16)).decode()
        self.stream.sendall((f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.file = self.stream.makefile("rb")
        while self.file.readline().strip():
            pass

    def send(self, data, kind=TEXT):
        size = len(data)
        length = bytes([0x80 | size]) if size < 126 else struct.pack(">BH", 0xFE, size) if size < 65536 else \
            struct.pack(">BQ", 0xFF, size)
        self.stream.sendall(bytes([0x80 | kind]) + length + bytes(4) + data)  # a mask of zeros

    def receive(self):
        """The next message as a whole."""
        message = b""
        while True:
            first, second = self.file.read(2)
            size = second & 127
            if size > 125:
                size = struct.unpack(*((">H", self.file.read(2)) if size == 126 else (">Q", self.file.read(8))))[0]
            content = self.file.read(size)
            if first & 15 == CLOSED:
                raise EOFError("the browser has hung up")
            if first & 15 == PING:
                self.send(content, PONG)
            elif first & 8 == 0:
                message += content
                if first & 128:
                    return message

    def close(self):
        self.file.close()
        self.stream.close()


class Browser:
    """One browser with one tab; use it by `with`."""

    def __init__(self, width=1280, height=800, options=()):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        # As root there is no sandbox; SwiftShader draws where there is no graphics card.
        self.process = subprocess.Popen(
            [os.environ.get("BROWSER", "chromium"), "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--no-first-run", "--hide-scrollbars", "--remote-debugging-port=0",
             f"--user-data-dir={self.folder.name}", f"--window-size={width},{height}", *options, "about:blank"],
            stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, errors="replace")
        self.errors, self.number, self.events = [], 0, []
        try:
            found = None
            while not found:
                line = self.process.stderr.readline()
                if not line:
                    raise RuntimeError("the browser has ended: " + " ".join(self.errors[-5:]))
                self.errors.append(line)
                found = re.search(r"ws://127\.0\.0\.1:(\d+)(/\S+)", line)
            self.socket = Socket(int(found[1]), found[2])
            self.session = None
            tab = self.call("Target.createTarget", url="about:blank")
            self.session = self.call("Target.attachToTarget", targetId=tab["targetId"], flatten=True)["sessionId"]
            for part in ("Page", "Runtime", "Network"):
                self.call(part + ".enable")
            self.resize(width, height)
        except BaseException:
            self.__exit__()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if hasattr(self, "socket"):
            self.socket.close()
        self.process.kill()
        self.process.wait()
        self.process.stderr.close()
        self.folder.cleanup()

    def call(self, method, **parameters):
        """The result of a command; events that come before are kept."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        self.socket.send(json.dumps(message).encode())
        while True:
            answer = json.loads(self.socket.receive())
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def resize(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def open(self, address):
        """Opens the page and waits until its scripts have run."""
        self.events.clear()
        self.call("Page.navigate", url=address)
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.events.append(json.loads(self.socket.receive()))

    def run(self, script):
        """The value of an expression of JavaScript; a promise is waited for."""
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"]["exception"].get("description", script))
        return result["result"].get("value")

    def frame(self):
        """Waits until what has changed is drawn."""
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def key(self, key):
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def screenshot(self, clip=None):
        """A PNG of the window, or of a part (x, y, width, height)."""
        options = {"clip": dict(zip(("x", "y", "width", "height"), clip), scale=1)} if clip else {}
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", **options)["data"])

    def pixels(self, clip):
        """The pixels of a part of the window, as rows of (red, green, blue)."""
        return decode_png(self.screenshot(clip))


def decode_png(data):
    """Rows of pixels of a PNG with 8 bits a channel, not interlaced (ISO/IEC 15948)."""
    place, packed = 8, b""
    while place < len(data):
        size, kind = struct.unpack(">I4s", data[place:place + 8])
        content = data[place + 8:place + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", content[:10])
            assert depth == 8 and colour in (2, 6)
        elif kind == b"IDAT":
            packed += content
        place += size + 12
    step = 3 if colour == 2 else 4
    raw, stride = zlib.decompress(packed), width * step
    rows, above = [], bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left, up, corner = (line[i - step], above[i], above[i - step]) if i >= step else (0, above[i], 0)
            if kind == 1:
                line[i] = (line[i] + left) & 255
            elif kind == 2:
                line[i] = (line[i] + up) & 255
            elif kind == 3:
                line[i] = (line[i] + (left + up) // 2) & 255
            elif kind == 4:
                guess = left + up - corner
                line[i] = (line[i] + min((left, up, corner), key=lambda near: abs(guess - near))) & 255
        rows.append([tuple(line[i:i + 3]) for i in range(0, stride, step)])
        above = line
    return rows
