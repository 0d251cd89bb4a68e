# SPDX-License-Identifier: Apache-2.0
"""Reports in a browser, with real clicks: report_pages.py PROGRAM, in the folder of test_report.sh."""
import json
import os
import re
import subprocess
import sys

from browser import Browser, available, decode_png

PROGRAM = sys.argv[1]
LEFT, RIGHT, DOWN, SPACE, ENTER = "\ue012", "\ue014", "\ue015", " ", "\ue007"
failures = 0


def check(good, text):
    global failures
    if not good:
        failures += 1
        print("FAIL:", text, file=sys.stderr)


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], check=True, capture_output=True, text=True).stdout


def developed(picture, stops):
    run("develop", picture, "-o", "developed.png", "--exposure", str(stops))
    with open("developed.png", "rb") as file:
        return decode_png(file.read())


def mean(pixels):
    return sum(pixels) / len(pixels)


def distance(a, b):
    """Mean and largest difference of two pictures of bytes."""
    check(a[:2] == b[:2], f"sizes differ: {a[:2]} and {b[:2]}")
    differences = [abs(x - y) for x, y in zip(a[2], b[2])]
    return mean(differences), max(differences)


def columns(picture, begin, end):
    width, height, pixels = picture
    return b"".join(pixels[4 * (y * width + begin):4 * (y * width + end)] for y in range(height))


def open_page(browser, path):
    browser.open(os.path.abspath(path))
    browser.wait("document.body.dataset.ready === 'yes' && document.body.dataset.painted !== undefined")


def settle(browser):
    browser.wait("document.body.dataset.painted === String(Number(document.getElementById('exposure').value))")


def test_exposure(browser, cells):
    stage, cell = browser.canvas("#canvas"), browser.canvas("#cell-0 canvas")
    shown = browser.screenshot("#canvas")
    check(len(set(cell[2])) > 40, "the first cell is blank")
    average, largest = distance(cell, developed(cells[0]["picture"], 0))
    check(average < 0.4 and largest <= 4, f"not as `tsuya develop` shows it: {average:.2f} on average, {largest} at most")
    browser.pointer("#exposure", [(0.64, 0.5)])
    settle(browser)
    stops = float(browser.script("return document.getElementById('exposure').value"))
    check(1.5 < stops < 3, f"a click on the slider gives {stops} stops")
    check(browser.text("#stops") == f"+{stops:.1f} stops", "the slider does not say its stops")
    average, largest = distance(browser.canvas("#cell-0 canvas"), developed(cells[0]["picture"], stops))
    check(average < 0.5 and largest <= 4, f"exposed otherwise than `tsuya develop`: {average:.2f} on average, {largest} at most")
    for index in range(len(cells)):
        check(len(set(browser.canvas(f"#cell-{index} canvas")[2])) > 40, f"cell {index} is blank")
    check(mean(browser.canvas("#canvas")[2]) > mean(stage[2]) + 8, "the slider does not brighten A and B")
    check(mean(browser.screenshot("#canvas")[2]) > mean(shown[2]) + 8, "the slider does not change what is seen")
    browser.keys("#exposure", LEFT)
    settle(browser)
    check(abs(float(browser.script("return document.getElementById('exposure').value")) - stops + 0.1) < 1e-6, "an arrow key is a tenth of a stop")
    browser.click("#reset")
    settle(browser)
    check(browser.canvas("#canvas") == stage and browser.canvas("#cell-0 canvas") == cell, "reset does not bring back the pixels")


def test_swipe(browser, cells):
    browser.script("document.getElementById('cell-0').focus()")
    browser.click("#cell-6")
    check(browser.script("return document.getElementById('b').value") == "6", "a click does not make the cell B")
    check(browser.text("#mark-6") == "B" and browser.text("#mark-0") == "A", "the cells are not marked")
    width = browser.canvas("#canvas")[0]
    browser.pointer("#canvas", [(0.5, 0.5), (0.9, 0.5), (1.0, 0.4)])
    a = browser.canvas("#canvas")
    browser.pointer("#canvas", [(0.9, 0.5), (0.3, 0.6), (0.0, 0.5)])
    b = browser.canvas("#canvas")
    check(a == browser.canvas("#cell-0 canvas") and b == browser.canvas("#cell-6 canvas"), "the ends of the border are not A and B")
    check(a != b, "two cells are the same picture")
    seen = browser.screenshot("#stage")
    browser.pointer("#canvas", [(0.05, 0.5), (0.25, 0.5)])
    half, border = browser.canvas("#canvas"), round(width * browser.script("return Number(document.getElementById('swipe').value)"))
    check(abs(border - width / 4) <= 1, f"the border is not under the mouse: {border} of {width}")
    check(columns(half, 0, border) == columns(a, 0, border), "left of the border is not A")
    check(columns(half, border, width) == columns(b, border, width), "right of the border is not B")
    check(browser.screenshot("#stage") != seen, "the swipe does not change what is seen")
    browser.press(RIGHT)
    check(round(width * browser.script("return Number(document.getElementById('swipe').value)")) > border, "the arrow key does not move the border")
    return a, b


def test_modes(browser, a, b):
    browser.click("#mode-flip")
    first = browser.canvas("#canvas")
    browser.pointer("#canvas", [(0.5, 0.5)])
    second = browser.canvas("#canvas")
    check({first[2], second[2]} == {a[2], b[2]}, "a click does not flip A and B")
    browser.script("document.getElementById('stage-frame').focus()")
    browser.press(SPACE)
    check(browser.canvas("#canvas") == first, "the space bar does not flip")
    browser.click("#auto")
    browser.wait("document.getElementById('flip').getAttribute('aria-pressed') === 'true'", 3)
    browser.wait("document.getElementById('flip').getAttribute('aria-pressed') === 'false'", 3)
    browser.click("#mode-difference")
    check(not browser.script("return document.getElementById('auto').checked"), "it goes on flipping behind the difference")
    plain = mean(browser.canvas("#canvas")[2])
    browser.pointer("#gain", [(0.9, 0.5)])
    check(mean(browser.canvas("#canvas")[2]) > plain + 5, "gain does not raise the difference")
    browser.click("#swap")
    check(browser.script("return [document.getElementById('a').value, document.getElementById('b').value]") == ["6", "0"], "swap does not exchange A and B")
    browser.click("#swap")
    browser.script("const e = document.getElementById('b'); e.value = '0'; e.onchange()")
    check(set(browser.canvas("#canvas")[2]) == {0, 255}, "a cell differs from itself")
    browser.script("document.getElementById('mode-difference').focus()")
    browser.press(RIGHT)
    check(browser.script("return document.getElementById('mode-swipe').getAttribute('aria-checked')") == "true", "arrow keys do not change the mode")


def measured(reference, test):
    return json.loads(run("compare", reference, test, "--json", "--metric", "rmse,relmse,psnr,flip"))["layers"][0]["metrics"]


def row_of(browser, index):
    return browser.script("return [...document.querySelectorAll(`#table tr[data-cell='${arguments[0]}'] td`)].map(e => e.textContent)", index)


def test_table(browser, cells, exact):
    head = browser.script("return [...document.querySelectorAll('#table thead th')].map(e => e.textContent)")
    for reference in (0, 5):
        browser.script("const e = document.getElementById('reference'); e.value = arguments[0]; e.onchange()", str(reference))
        check("reference" in row_of(browser, reference), "the reference is not marked")
        row, expected = row_of(browser, 9), measured(cells[reference]["picture"], cells[9]["picture"])
        for name, key in (("RMSE", "rmse"), ("relMSE", "relmse"), ("PSNR, dB", "psnr"), ("FLIP", "flip")):
            text = row[head.index(name)]
            if not exact and key == "flip":
                check(text == "–", f"a FLIP that nobody measured: {text}")
                continue
            check(text.startswith("≈ ") != exact, f"{name}: '{text}' does not say where it comes from")
            value = float(text.replace("≈ ", ""))
            check(abs(value - expected[key]) < (2e-3 if exact else 1e-2) * abs(expected[key]), f"{name} is {text}, `tsuya compare` says {expected[key]}")
    rmse = head.index("RMSE")
    browser.click(f"#table thead th:nth-child({rmse + 1}) button")
    order = [r[rmse] for r in map(lambda i: row_of(browser, i), browser.script(
        "return [...document.querySelectorAll('#table tbody tr')].map(e => Number(e.dataset.cell))"))]
    values = [float(t.replace("≈ ", "")) for t in order if t != "reference"]
    check(values == sorted(values) and len(values) == 11, "a click on a heading does not sort")
    browser.click("#table tr[data-cell='7'] td")
    check(browser.script("return document.getElementById('b').value") == "7", "a click on a line does not make the cell B")


def test_command(browser, cells):
    browser.click("#cell-3")
    browser.click("#copy-b")
    browser.wait("document.body.dataset.copied")
    command = browser.script("return document.body.dataset.copied")
    check(command == cells[3]["command"] and browser.text("#commands dd:last-child code") == command, "another command than the sweep's")
    before = open(cells[3]["picture"], "rb").read()
    os.remove(cells[3]["picture"])
    subprocess.run(["bash", "-c", 'tsuya() { "$PROGRAM" "$@"; }; ' + command], check=True, capture_output=True, env={**os.environ, "PROGRAM": PROGRAM})
    check(open(cells[3]["picture"], "rb").read() == before, "the copied command makes other bytes")


def test_access(browser):
    for mode in ("swipe", "flip", "difference"):
        browser.click("#mode-" + mode)
        for element in browser.find_all("button, input, select, canvas[role]"):
            if browser.call(f"/element/{element}/displayed"):
                check(browser.label(element), "a control without a name: " + browser.call(f"/element/{element}/property/outerHTML")[:200])
    browser.script("document.getElementById('cell-0').focus()")
    browser.press(RIGHT + DOWN)
    check(browser.script("return document.activeElement.id") == "cell-5", "arrow keys do not go from cell to cell")
    browser.press(ENTER)
    check(browser.script("return document.getElementById('b').value") == "5", "the enter key does not make the cell B")
    browser.press("r")
    check(browser.script("return document.getElementById('a').value") == "5", "r does not make the cell A")
    for width in (390, 760, 1440):
        browser.resize(width, 900)
        wide = browser.script("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
        check(wide <= 0, f"the page is {wide} pixels wider than a window of {width}")


def test_quiet(browser):
    errors = browser.console_errors()
    check(not errors, f"messages on the console: {errors}")
    asked = [url for url in browser.requests() if not url.startswith(("file:", "data:", "blob:"))]
    check(not asked, f"asked of the network: {asked}")


def test_compare(browser):
    open_page(browser, "compare.html")
    check("differs" in browser.text("#facts"), "the page does not judge")
    bad = browser.script("return [...document.querySelectorAll('#table td.bad')].map(e => e.textContent)")
    check(len(bad) == 1, f"one broken limit expected, not {bad}")
    for name, index in (("a.exr", 0), ("b.exr", 1)):
        average, largest = distance(browser.canvas(f"#cell-{index} canvas"), developed(name, 0))
        check(average < 0.4 and largest <= 4, f"{name} is not as `tsuya develop` shows it: {average:.2f}, {largest}")
    heat, a = browser.canvas("#cell-2 canvas"), browser.canvas("#cell-0 canvas")
    browser.pointer("#exposure", [(0.7, 0.5)])
    settle(browser)
    check(browser.canvas("#cell-2 canvas") == heat, "exposure changes the error's colours")
    check(mean(browser.canvas("#cell-0 canvas")[2]) > mean(a[2]) + 8, "exposure does not change the picture")
    open_page(browser, "display.html")
    average, largest = distance(browser.canvas("#cell-0 canvas"), decode_png(open("a.png", "rb").read()))
    check(average < 0.2 and largest <= 1, f"a PNG is not shown as it is: {average:.2f}, {largest}")
    open_page(browser, "layers.html")
    check(len(browser.find_all("#grid tr")) > 6, "a line for every layer expected")
    browser.open(os.path.abspath("size.html"))
    browser.wait("document.body.dataset.ready === 'yes'")
    check("display windows differ" in browser.text("#fault"), "the page does not say why there is no comparison")
    test_quiet(browser)


def test_failed(browser):
    open_page(browser, "failing/index.html")
    check(len(browser.find_all(".cell canvas")) == 2, "the cells beside a failed one are missing")
    check("at most the radius" in browser.text(".cell .missing"), "a failed cell does not say why")
    check("failed" in row_of(browser, 1), "the table does not mark a failed cell")
    browser.click("#cell-1")
    check(browser.script("return document.getElementById('b').value") == "2", "a failed cell becomes B")
    open_page(browser, "wide/index.html")
    browser.pointer("#canvas", [(0.501, 0.5)], hold=False)
    x = int(browser.text("#readout").split(",")[0])
    check(abs(x - 701) <= 3 and x % 2 == 0, f"the middle of 1400 pixels is not {x}")
    test_quiet(browser)


def test_damaged(browser):
    page = open("grid/index.html", encoding="utf-8").read()
    with open("damaged.html", "w", encoding="utf-8") as file:
        file.write(re.sub(r'(id="picture-3">.{200}).*?(</script>)', r"\1\2", page, count=1))
    browser.open(os.path.abspath("damaged.html"))
    browser.wait("!document.getElementById('fault').hidden")
    browser.console_errors()


def main():
    wanted = os.environ.get("TSUYA_BROWSER", "if there") # or "required", or "none"
    if wanted == "none" or not available():
        return 1 if wanted == "required" else 77
    cells = json.load(open("grid/sweep.json"))["cells"]
    browser = Browser(1440, 900)
    try:
        open_page(browser, "grid/index.html")
        check(len(browser.find_all(".cell canvas")) == 12, "twelve cells expected")
        test_exposure(browser, cells)
        test_modes(browser, *test_swipe(browser, cells))
        test_table(browser, cells, True)
        test_command(browser, cells)
        test_access(browser)
        test_quiet(browser)
        # The same page without the program's measures.
        page = open("grid/index.html", encoding="utf-8").read()
        with open("bare.html", "w", encoding="utf-8") as file:
            file.write(re.sub(r'"pairs":\[.*?\}\]', '"pairs":[]', page, count=1))
        open_page(browser, "bare.html")
        test_table(browser, cells, False)
        test_damaged(browser)
        test_failed(browser)
        test_compare(browser)
    finally:
        browser.close()
    return 1 if failures else 0


sys.exit(main())
