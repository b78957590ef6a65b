#!/usr/bin/python3
"""docs/site.py makes one HTML page from each page; all links have a target, and the search finds each page: site_test.py PROJECT; 77: no python3-markdown"""
import json, re, subprocess, sys, tempfile
from pathlib import Path

try:
    import markdown
except ModuleNotFoundError:
    print("skipped: Debian's package python3-markdown is missing")
    sys.exit(77)

docs = Path(sys.argv[1]).resolve() / "docs"
wrong = []
with tempfile.TemporaryDirectory(prefix="driftwright-site-") as folder:
    site = Path(folder).resolve()
    subprocess.run([sys.executable, docs / "site.py", site], check=True)
    pages = {p.relative_to(docs).with_suffix(".html") if p.name != "README.md" else Path("index.html"): p for p in docs.rglob("*.md")}
    found = {Path(p["address"]) for p in json.loads((site / "pages.js").read_text().removeprefix("const PAGES="))}
    wrong += [f"{page}: not made" for page in pages if not (site / page).exists()]
    wrong += [f"{page}: search does not know it" for page in set(pages) ^ found]
    ids = {page: set(re.findall(r' id="([^"]*)"', (site / page).read_text())) for page in found}
    for page in found:
        html = (site / page).read_text()
        main = html.split("<main>")[1].split("</main>")[0]
        text = re.sub(r"<pre>.*?</pre>", "", main, flags=re.S)
        for line in re.findall(r"^(?:- |\| |#+ ).*$", text, re.M) + ([] if main.startswith("<h1") else ["no heading"]):
            wrong.append(f"{page}: not a list, table or heading: {line[:80]}")
        for link in re.findall(r'(?:href|src)="([^"]*)"', html):
            path, _, anchor = link.partition("#")
            to = (site / page).parent.joinpath(path).resolve() if path else site / page
            if not re.match(r"[a-z]+:", link) and not (to.exists() and (not anchor or anchor in ids[to.relative_to(site)])):
                wrong.append(f"{page}: {link} is not there")
print("\n".join(wrong) or f"{len(found)} pages")
sys.exit(bool(wrong))
