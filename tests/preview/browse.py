"""The page of `trapeze render --preview web`, as tests/preview/run looks at it by chromedriver."""
import base64
import json
import pathlib
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request

program, root, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Browser:
    """A session of headless Chromium."""

    def __init__(self, driver_port, dark):
        self.base = f"http://127.0.0.1:{driver_port}/session"
        scheme = 0 if dark else 1
        options = {"binary": "/usr/bin/chromium",
                   "args": ["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1280,900",
                            f"--blink-settings=preferredColorScheme={scheme}"]}
        capabilities = {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        self.base += "/" + self.ask("POST", "", {"capabilities": {"alwaysMatch": capabilities}})["sessionId"]

    def ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as problem:
            sys.exit(f"chromedriver: {json.load(problem)['value']['message']}")

    def run(self, script, *arguments):
        return self.ask("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, what, script, seconds=60):
        until = time.monotonic() + seconds
        while not self.run("return " + script):
            if time.monotonic() > until:
                self.shoot("failed")
                sys.exit(f"waited in vain until {what}: {self.text('stage')}")
            time.sleep(0.05)

    def text(self, element):
        return self.run("return document.getElementById(arguments[0]).textContent", element)

    def set(self, element, value, event="input"):
        self.run("const e = document.getElementById(arguments[0]); e.value = arguments[1];"
                 "e.dispatchEvent(new Event(arguments[2]))", element, value, event)
        time.sleep(0.3)

    def shoot(self, name):
        (folder / (name + ".png")).write_bytes(base64.b64decode(self.ask("GET", "/screenshot")))

    def save_canvas(self, file):
        url = self.run("return document.getElementById('canvas').toDataURL('image/png')")
        pathlib.Path(file).write_bytes(base64.b64decode(url.split(",", 1)[1]))

    def point_at(self, x, y):
        """Moves the pointer over a pixel of the picture."""
        at = self.run("const b = document.getElementById('canvas').getBoundingClientRect(),"
                      "c = document.getElementById('canvas'), s = b.width / c.width;"
                      "return [b.left + (arguments[0] + .5) * s, b.top + (arguments[1] + .5) * s]", x, y)
        move = {"type": "pointerMove", "duration": 0, "x": round(at[0]), "y": round(at[1])}
        self.ask("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [move]}]})

    def fingers(self, *paths):
        """Each finger is put down at the first of its points of the window, goes to the others, and is lifted."""
        def steps(path):
            moves = [{"type": "pointerMove", "duration": 50, "x": x, "y": y} for x, y in path]
            return [moves[0], {"type": "pointerDown", "button": 0}, *moves[1:], {"type": "pointerUp", "button": 0}]
        self.ask("POST", "/actions", {"actions": [
            {"type": "pointer", "id": f"finger{i}", "parameters": {"pointerType": "touch"}, "actions": steps(path)}
            for i, path in enumerate(paths)]})

    def drag(self, *path):
        """The same by the mouse."""
        moves = [{"type": "pointerMove", "duration": 0, "x": x, "y": y} for x, y in path]
        steps = [moves[0], {"type": "pointerDown", "button": 0}, *moves[1:], {"type": "pointerUp", "button": 0}]
        self.ask("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": steps}]})

    def place(self):
        """Left, top and width of the picture in the window, in pixels."""
        return self.run("const b = document.getElementById('canvas').getBoundingClientRect();"
                        "return [b.left, b.top, b.width]")

    def close(self):
        self.ask("DELETE", "")


def render(output, port, *options):
    command = [program, "render", str(root / "scenes/gallery/spot.rib"), "--resolution", "960x540", "--samples",
               "12x12", "-o", output, "--aov", "N,albedo", "--preview", f"web:{port}", *options]
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)


def expect_end(run):
    _, said = run.communicate(timeout=120)
    if run.returncode != 0:
        sys.exit(f"the render ended with {run.returncode}: {said}")


def expect_same(shown, picture, what, tolerance=1):
    """Whether a canvas has a picture's colours within so many of 255."""
    subprocess.run(["oiiotool", picture, "--ch", "R,G,B", "--clamp:min=0:max=1", "--colorconvert", "linear", "sRGB", "-d",
                    "uint8", "-o", "expected.png"], check=True, stdout=subprocess.DEVNULL)
    limit = str((tolerance + 0.5) / 255)
    diff = subprocess.run(["oiiotool", shown, "--ch", "R,G,B", "expected.png", "--fail", limit, "--warn", limit,
                           "--diff"], capture_output=True, text=True)
    if diff.returncode != 0:
        sys.exit(f"{what}: {diff.stdout}")


def nobody_else_was_asked(browser, port):
    names = browser.run("return performance.getEntriesByType('resource').map(e => e.name)")
    strange = [name for name in names if not name.startswith((f"http://127.0.0.1:{port}/", "data:"))]
    if not names or strange:
        sys.exit(f"the page has asked others: {strange}")
    # What it asks of a program that is gone fails, and browsers say so.
    problems = [entry["message"] for entry in browser.ask("POST", "/se/log", {"type": "browser"})
                if "ERR_CONNECTION_REFUSED" not in entry["message"] and "ERR_EMPTY_RESPONSE" not in entry["message"]]
    if problems:
        sys.exit(f"the console says: {problems}")


def expect_place(browser, expected, what):
    place = browser.place()
    if any(abs(is_ - should) > 1 for is_, should in zip(place, expected)):
        sys.exit(f"{what}: the picture is at {place}, not at {expected}")


def move_about(browser):
    """A drag goes on outside of the picture's stand; two fingers move and enlarge."""
    left, top, width = browser.place()
    stand_top = browser.run("return document.getElementById('stand').getBoundingClientRect().top")
    if stand_top < 20:
        sys.exit("there is nothing above the picture's stand to drag to")
    browser.drag((400, 400), (450, 300), (460, 5))
    expect_place(browser, (left + 60, top - 395, width), "after a drag")
    browser.drag((460, 5), (400, 400))
    expect_place(browser, (left + 60, top - 395, width), "after a drag from elsewhere")
    browser.drag((400, 300), (400, 665))
    browser.fingers([(400, 400), (300, 400)], [(500, 400), (500, 400)])
    # 100 pixels apart, then 200: what was half way between them still is, and twice as large.
    expect_place(browser, (400 - 2 * (450 - left - 60), 400 - 2 * (400 - top + 30), 2 * width), "after a pinch")
    browser.run("document.getElementById('fit').click()")
    expect_place(browser, (left, top, width), "when it fits again")


def look(driver_port, dark):
    shade = "dark" if dark else "light"
    port = free_port()
    browser = Browser(driver_port, dark)
    run = render(f"first-{shade}.exr", port)
    time.sleep(1)
    browser.ask("POST", "/url", {"url": f"http://127.0.0.1:{port}/"})
    browser.wait("a third is done", "document.getElementById('progress').value > .33")
    browser.shoot(f"{shade}-1-making")
    if "left" not in browser.text("stage"):
        sys.exit(f"no time left is told: {browser.text('stage')}")
    browser.wait("it is finished", "document.getElementById('stage').textContent === 'finished'")
    expect_end(run)
    time.sleep(1.5)
    browser.save_canvas("shown.png")
    expect_same("shown.png", f"first-{shade}.exr", "the finished picture")
    browser.point_at(480, 200)
    if "albedo.R" not in browser.text("pixel"):
        sys.exit(f"not all values of a pixel are told: {browser.text('pixel')}")
    browser.shoot(f"{shade}-2-finished")
    move_about(browser)
    browser.set("layer", "N", "change")
    browser.shoot(f"{shade}-3-normals")
    browser.set("layer", "RGB", "change")

    # Another run, at the same port, on the same page.
    run = render(f"second-{shade}.exr", port, "--option", 'Option "user" "float unused" [0] Exposure 0.25 1')
    browser.wait("another picture begins",
                 f"document.getElementById('name').textContent === 'second-{shade}.exr'")
    browser.wait("it is finished, too", "document.getElementById('stage').textContent === 'finished'")
    expect_end(run)
    time.sleep(1.5)
    browser.save_canvas("shown.png")
    expect_same("shown.png", f"second-{shade}.exr", "the picture of another run")
    browser.set("split", "1")
    browser.save_canvas("shown.png")
    expect_same("shown.png", f"first-{shade}.exr", "the picture before")
    browser.set("split", "0.5")
    browser.point_at(480, 200)
    browser.shoot(f"{shade}-4-before-and-after")
    browser.set("split", "0")
    browser.set("exposure", "1")
    subprocess.run(["oiiotool", f"second-{shade}.exr", "--ch", "R,G,B", "--mulc", "2", "-o", "brighter.exr"], check=True)
    browser.save_canvas("shown.png")
    expect_same("shown.png", "brighter.exr", "a stop more of exposure")
    nobody_else_was_asked(browser, port)
    browser.close()


def look_at_view(driver_port):
    """By OpenColorIO: the program's own config."""
    port = free_port()
    browser = Browser(driver_port, False)
    run = render("viewed.exr", port, "--view", "sRGB")
    time.sleep(1)
    browser.ask("POST", "/url", {"url": f"http://127.0.0.1:{port}/"})
    browser.wait("it is finished", "document.getElementById('stage').textContent === 'finished'")
    expect_end(run)
    time.sleep(1.5)
    browser.save_canvas("shown.png")
    expect_same("shown.png", "viewed.exr", "a picture by its view")
    if "sRGB" not in browser.text("view-name"):
        sys.exit("the view is not named")
    browser.shoot("view")
    browser.close()


def look_away():
    """A page that was stopped in the middle of things changes nothing."""
    port, driver_port = free_port(), free_port()
    driver = subprocess.Popen(["chromedriver", f"--port={driver_port}"], stdout=subprocess.DEVNULL)
    time.sleep(1)
    browser = Browser(driver_port, False)
    run = render("alone.exr", port)
    time.sleep(1)
    browser.ask("POST", "/url", {"url": f"http://127.0.0.1:{port}/"})
    browser.wait("a tenth is done", "document.getElementById('progress').value > .1")
    stopped = subprocess.run(["pgrep", "-f", "chromium.*type=renderer"], capture_output=True, text=True).stdout.split()
    for process in stopped:
        subprocess.run(["kill", "-STOP", process])
    expect_end(run)
    for process in stopped:
        subprocess.run(["kill", "-CONT", process])
    browser.close()
    driver.send_signal(signal.SIGTERM)
    if pathlib.Path("alone.exr").stat().st_size == 0:
        sys.exit("the picture is empty")


driver_port = free_port()
driver = subprocess.Popen(["chromedriver", f"--port={driver_port}"], stdout=subprocess.DEVNULL)
try:
    time.sleep(1)
    for dark in (False, True):
        look(driver_port, dark)
    look_at_view(driver_port)
    look_away()
finally:
    driver.terminate()
print("the page shows what is written, light and dark")
