#!/usr/bin/env python3
"""Takes a picture of a step of a page of swiftprox-replay --html in headless Chromium, without a graphics card:

  page_picture.py PAGE.html PICTURE.png STEP [WIDTH HEIGHT]"""
import os
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.insert(0, os.path.join(ROOT, "tools"))
import browser  # noqa: E402


def main():
    if len(sys.argv) not in (4, 6):
        sys.exit(__doc__)
    page, picture, step = sys.argv[1:4]
    with browser.Browser(*map(int, sys.argv[4:] or (1200, 700))) as tab:
        tab.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
        tab.open("file://" + os.path.abspath(page))
        tab.run(f"page.goTo({int(step)})")
        tab.frame()
        with open(picture, "wb") as out:
            out.write(tab.screenshot())


if __name__ == "__main__":
    main()
