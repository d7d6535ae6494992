#!/usr/bin/env python3
"""Opens pages in a headless Chromium at three widths, light and dark, and says what is wrong with them.

    check.py [--shots DIR] PAGE.html...
    check.py --self-test

Checked: no console errors, no request that leaves the file, no horizontal overflow of the document, every figure of some
size, no text of a drawing outside its frame or over another text, and what axe-core says of contrast and structure.
"""

import argparse
import pathlib
import shutil
import sys
import tempfile

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import sync_playwright

WIDTHS = (360, 800, 1400)
SCHEMES = ("light", "dark")

# axe looks at every element: of long lists of like rows the first few stand for all.
AXE_MOST = 8

OPEN = "document.querySelectorAll('details').forEach(d => { d.open = true })"
CLOSE = "document.querySelectorAll('details').forEach(d => { d.open = d.dataset.first === '1' })"
REMEMBER = "document.querySelectorAll('details').forEach(d => { d.dataset.first = d.open ? '1' : '0' })"

OVERFLOW = """() => {
  const wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  if (wide <= 0) return [];
  const edge = document.documentElement.clientWidth + 1;
  const culprits = [...document.body.querySelectorAll('*')]
    .filter(e => !e.closest('.scroll') && e.getBoundingClientRect().right > edge)
    .slice(0, 3).map(e => e.outerHTML.slice(0, 120));
  return ['the document is ' + wide + ' px too wide: ' + culprits.join(' | ')];
}"""

DRAWINGS = """() => {
  const faults = [];
  for (const svg of document.querySelectorAll('svg')) {
    const name = svg.querySelector('title')?.textContent.slice(0, 80) ?? '?';
    const frame = svg.getBoundingClientRect();
    if (frame.width < 100 || frame.height < 60) {
      faults.push(`${name}: drawn ${frame.width} × ${frame.height}`);
      continue;
    }
    const texts = [...svg.querySelectorAll('text')].map(t => ({ text: t.textContent, box: t.getBoundingClientRect() }));
    for (const { text, box } of texts) {
      const slack = 0.6;
      if (box.left < frame.left - slack || box.right > frame.right + slack ||
          box.top < frame.top - slack || box.bottom > frame.bottom + slack)
        faults.push(`${name}: '${text}' leaves the drawing`);
    }
    // A line box is taller than its letters: texts on neighbouring lines may share a little of it.
    const scale = frame.width / svg.viewBox.baseVal.width;
    for (let i = 0; i < texts.length; i++)
      for (let j = i + 1; j < texts.length; j++) {
        const [a, b] = [texts[i].box, texts[j].box];
        const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (across > 0.5 * scale && down > 2.5 * scale)
          faults.push(`${name}: '${texts[i].text}' and '${texts[j].text}' overlap`);
      }
    const shapes = [...svg.querySelectorAll('path')].filter(p => !(p.getAttribute('d') ?? '').trim());
    if (shapes.length) faults.push(`${name}: ${shapes.length} empty paths`);
  }
  return faults;
}"""

# Rows beyond the first few of a list that repeats itself.
THIN = """most => {
  for (const parent of document.querySelectorAll('.claims, .cases, tbody, .figures'))
    [...parent.children].slice(most).forEach(e => e.remove());
}"""


def look(browser, page_file, shots):
    faults = []
    for scheme in SCHEMES:
        for width in WIDTHS:
            where = f"{width} px, {scheme}"
            context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
            page = context.new_page()
            page.on("console", lambda m: faults.append(f"{where}: console: {m.text}") if m.type == "error" else None)
            page.on("pageerror", lambda e: faults.append(f"{where}: {e}"))
            page.on(
                "request",
                lambda r: None if r.url.startswith(("file:", "data:")) else faults.append(f"{where}: asks for {r.url}"),
            )
            page.goto(page_file.resolve().as_uri())
            page.evaluate(REMEMBER)
            faults += [f"{where}: {fault}" for fault in page.evaluate(OVERFLOW)]
            page.evaluate(OPEN)
            faults += [f"{where}, all open: {fault}" for fault in page.evaluate(OVERFLOW)]
            if scheme == "light":
                faults += [f"{where}: {fault}" for fault in page.evaluate(DRAWINGS)]
            if shots:
                page.evaluate(CLOSE)
                name = f"{page_file.parent.name}-{page_file.stem}-{width}-{scheme}"
                page.screenshot(path=shots / f"{name}.png")
            # Structure is the same at every width; contrast differs by scheme only.
            if width == 800:
                page.evaluate(OPEN)
                page.evaluate(THIN, AXE_MOST)
                result = Axe().run(page)
                for violation in result.response["violations"]:
                    nodes = violation["nodes"]
                    target = nodes[0]["html"][:160]
                    faults.append(f"{where}: axe {violation['id']} × {len(nodes)}: {violation['help']}: {target}")
            context.close()
    return faults


# One of each fault that the check is for.
BAD = """<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>bad</title></head><body><main><h1>bad</h1>
<p style="color:#aaa;background:#fff">pale</p><div style="width:2000px">wide</div><img src="http://localhost:9/x.png" alt="x">
<svg viewBox="0 0 200 100" width="200" height="100"><title>drawing</title><text x="10" y="20">one text</text>
<text x="20" y="22">over another</text><text x="190" y="60">beyond the edge</text><path d=""/></svg>
<svg viewBox="0 0 200 100" width="10" height="5"><title>tiny</title></svg>
<script>console.error("said so")</script></main></body></html>"""
EXPECTED = (
    "px too wide", "asks for", "console: said so", "'one text' and 'over another' overlap",
    "'beyond the edge' leaves the drawing", "empty paths", "tiny: drawn 10", "axe color-contrast",
)


def self_test(browser):
    with tempfile.TemporaryDirectory() as folder:
        bad = pathlib.Path(folder) / "bad.html"
        bad.write_text(BAD, encoding="utf-8")
        faults = look(browser, bad, None)
    missed = [expected for expected in EXPECTED if not any(expected in fault for fault in faults)]
    for expected in missed:
        print(f"a page made to fail does not fail on: {expected}")
    print(f"{len(EXPECTED) - len(missed)} passed, {len(missed)} failed")
    return 1 if missed else 0


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--shots", type=pathlib.Path, help="write screenshots to this folder")
    arguments.add_argument("--most", type=int, default=12, help="faults shown of each page")
    arguments.add_argument("--self-test", action="store_true", help="a page with every fault must be found faulty")
    arguments.add_argument("pages", nargs="*", type=pathlib.Path)
    given = arguments.parse_args()
    if given.shots:
        given.shots.mkdir(parents=True, exist_ok=True)
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        sys.exit("no chromium: install Debian's package chromium")
    bad = 0
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        if given.self_test:
            return self_test(browser)
        for page_file in given.pages:
            faults = look(browser, page_file, given.shots)
            bad += bool(faults)
            print(f"{page_file}: {len(faults)} faults" if faults else f"{page_file}: as it should be", flush=True)
            for fault in faults[: given.most]:
                print(f"  {fault}")
        browser.close()
    print(f"{len(given.pages) - bad} passed, {bad} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
