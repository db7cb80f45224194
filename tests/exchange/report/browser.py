#!/usr/bin/env python3
"""Pages of `catoptric` in a real browser: Chromium, headless, as Debian's package has it.

browser.py PROGRAM DATA

Makes a page by design, simulate, tradeoff and study, opens each and asks: is the console silent, does every figure have a
size, does the view in space show more than its background, was nothing asked of any other address, does the page fit a
narrow window, is a hostile title only words. Then it breaks a page on purpose in each of these ways, and each must be found.
Ends with 77 (skipped) where there is no Chromium or no Selenium, with 1 where a page fails.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError:
    print("python3-selenium is not installed")
    sys.exit(77)

TITLE = "</script><script>window.hacked = 1</script><img src=x onerror='window.hacked = 2'> & \"{{title}}\""
FEW = ["--set", "model.photons=4000", "--set", "model.replicates=2", "--set", "near_field.samples=200"]
LEAST_FIGURES = {"design": 6, "simulate": 4, "tradeoff": 2, "study": 2}
NARROW = 600

# What of a figure is no figure: one that takes no room, or holds no line of a curve.
FIGURES = """return Array.from(document.querySelectorAll("figure .picture")).map((box) => {
  const svg = box.querySelector("svg"), size = svg ? svg.getBoundingClientRect() : {width: 0, height: 0};
  const drawn = svg ? svg.querySelectorAll("path, image, polygon").length : 0;
  return {name: box.getAttribute("aria-label"), width: size.width, height: size.height, drawn: drawn};
});"""
# The share of the view's pixels that are not its background, and how many colours there are.
VIEW = """const done = arguments[0], canvas = document.querySelector("#view-3d canvas");
if (!canvas) { done(null); return; }
const copy = document.createElement("canvas"), image = new Image();
image.onload = () => {
  copy.width = image.width; copy.height = image.height;
  const context = copy.getContext("2d");
  context.drawImage(image, 0, 0);
  const data = context.getImageData(0, 0, copy.width, copy.height).data, colours = new Set();
  let inked = 0;
  for (let i = 0; i < data.length; i += 4)
    if (data[i + 3] > 0) { ++inked; colours.add(data[i] + "," + data[i + 1] + "," + data[i + 2]); }
  done({share: inked / (data.length / 4), colours: colours.size});
};
image.onerror = () => done(null);
image.src = canvas.toDataURL("image/png");"""


def browser():
    program, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not program or not driver:
        print("chromium or chromium-driver is not installed")
        sys.exit(77)
    options = Options()
    options.binary_location = program
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader", "--window-size=1200,1000"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(driver), options=options)


def outside_requests(window, address):
    asked = []
    for entry in window.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] != "Network.requestWillBeSent":
            continue
        url = message["params"]["request"]["url"]
        if url.split("#")[0] != address and not url.startswith(("data:", "blob:", "chrome")):
            asked.append(url)
    return asked


def defects(window, page, least_figures, has_view):
    """What is wrong with a page, in words; nothing where all is well."""
    address = "file://" + page
    for log in ("browser", "performance"):
        window.get_log(log)  # of the page before
    window.set_window_size(1200, 1000)
    window.get(address)
    found = [f"figure of no size or without a curve: {figure}" for figure in window.execute_script(FIGURES)
             if figure["width"] < 100 or figure["height"] < 100 or figure["drawn"] == 0]
    count = len(window.execute_script(FIGURES))
    if count < least_figures:
        found.append(f"{count} figures, {least_figures} are the least")
    if has_view:
        view = window.execute_async_script(VIEW)
        if view is None or view["share"] < 0.02 or view["colours"] < 20:
            found.append(f"the view in space is empty: {view}")
    if window.execute_script("return window.hacked"):
        found.append("a text of the scene was run as a script")
    window.set_window_size(NARROW, 1000)
    wide = window.execute_script("return document.scrollingElement.scrollWidth - document.scrollingElement.clientWidth")
    if wide > 0:
        found.append(f"wider than a narrow window by {wide} pixels")
    found += [f"console: {entry['message']}" for entry in window.get_log("browser")]
    found += [f"asked for {url}" for url in outside_requests(window, address)]
    return found


def run(program, arguments):
    ended = subprocess.run([program] + arguments + ["--quiet"], capture_output=True, text=True)
    if ended.returncode not in (0, 5):
        sys.exit(f"{arguments}: {ended.stdout}{ended.stderr}")


def make_pages(program, data, folder):
    scene = f"{data}/paper/start_a.toml"
    study = f"{folder}/study.toml"
    with open(study, "w", encoding="utf-8") as file:
        file.write(f"title = {json.dumps(TITLE)}\nscene = {json.dumps(scene)}\n[[runs]]\nname = \"a\"\n"
                   "[[runs]]\nname = \"b-2\"\nset = {\"variables.w1.start\" = 1.0}\n")
    title = ["--set", f"title={json.dumps(TITLE)}"]
    run(program, ["design", scene, "--out", f"{folder}/design"] + FEW + title)
    run(program, ["simulate", f"{data}/examples/low_bay.toml", "--out", f"{folder}/simulate"] + FEW + title)
    run(program, ["tradeoff", f"{data}/paper/paraboloid.toml", "--out", f"{folder}/tradeoff", "--set", "tradeoff.seeds=1",
                  "--set", "tradeoff.seconds=0.002", "--set", "tradeoff.most_photons=4000"] + FEW + title)
    run(program, ["study", study, "--out", f"{folder}/study"] + FEW)


def broken(page, folder, name, old, new):
    """A page that is wrong in one way."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    if old not in text:
        sys.exit(f"{page} has no {old}")
    path = f"{folder}/{name}.html"
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace(old, new, 1))
    return path


def main():
    program, data = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        window = browser()
        try:
            make_pages(program, data, folder)
            for command, least in LEAST_FIGURES.items():
                page = f"{folder}/{command}/report.html"
                has_view = command != "study"
                found = defects(window, page, least, has_view)
                if os.path.getsize(page) > 2_500_000:
                    found.append(f"{os.path.getsize(page)} bytes are too many")
                title = window.find_element("tag name", "h1").text
                if title != TITLE:
                    found.append(f"the title has become {title!r}")
                print(f"{command}: {os.path.getsize(page)} bytes, {'; '.join(found) or 'nothing wrong'}")
                failed |= bool(found)
            page = f"{folder}/design/report.html"
            image = "<main><img src=\"http://127.0.0.1:65000/x.png\" alt=\"\">"
            # what is broken, and the words that must be in what is found
            twins = {
                "a picture of no size": ("<svg", "<svg style=\"width:0;height:0\"", "no size"),
                "a view without data": ("\"mirror\":[[", "\"mirror\":[], \"was\":[[", "view in space"),
                "a script that ends early": ("<script nonce=\"catoptric\">(function",
                                             "<script nonce=\"catoptric\">((function", "SyntaxError"),
                "an address outside": ("img-src data:", "img-src data: *", "asked for http://127.0.0.1"),
                "a page too wide": ("<main>", "<main><div style=\"width:900px\">.</div>", "wider"),
            }
            for name, (old, new, words) in twins.items():
                path = broken(page, folder, name.replace(" ", "_"), old, new)
                if name == "an address outside":
                    path = broken(path, folder, "address", "<main>", image)
                found = [defect for defect in defects(window, path, LEAST_FIGURES["design"], True) if words in defect]
                print(f"wrong twin, {name}: {'found: ' + found[0][:150] if found else 'NOT FOUND'}")
                failed |= not found
        finally:
            window.quit()
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
