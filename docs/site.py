#!/usr/bin/python3
"""Makes a static site with search from the pages in docs/: site.py FOLDER   (it needs Debian's python3-markdown; the site works from disk, without a server)"""
import json, os, re, shutil, sys
from html import escape, unescape
from pathlib import Path

DOCS = Path(__file__).resolve().parent
SHELVES = {"start": "Start", "how-to": "How to", "reference": "Reference", "theory": "Theory and evidence"}
STYLE = """body{margin:0;font:16px/1.5 sans-serif;color:#222;display:flex}nav{width:15em;padding:1em;background:#f3f3f3;height:100vh;overflow:auto;position:sticky;top:0;box-sizing:border-box;flex:none}
nav a{display:block;text-decoration:none;color:#245;padding:1px 0}nav b{display:block;margin-top:.8em}nav input{width:100%;box-sizing:border-box}main{padding:1em 2em;max-width:60em;min-width:0}
img{max-width:100%}pre{background:#f6f6f6;padding:.6em;overflow:auto}table{border-collapse:collapse;display:block;overflow:auto}td,th{border:1px solid #ccc;padding:2px 6px;vertical-align:top;text-align:left}mark{background:#fe9}"""
SEARCH = """const box=document.getElementById('search'),found=document.getElementById('found');
box.oninput=()=>{const words=box.value.toLowerCase().split(/\\s+/).filter(Boolean);found.textContent='';if(!words.length)return;
const score=p=>words.every(w=>p.text.includes(w))?words.reduce((s,w)=>s+p.text.split(w).length-1+(p.title.toLowerCase().includes(w)?50:0),0):0;
for(const p of PAGES.map(p=>[score(p),p]).filter(p=>p[0]).sort((a,b)=>b[0]-a[0]).slice(0,12).map(p=>p[1])){const a=document.createElement('a');a.href=ROOT+p.address;a.textContent=p.title;found.append(a)}}"""


def slug(heading, _separator=""):
    """The anchor of a heading, as GitHub and tests/project/links_test.py make it."""
    return re.sub(r"[^\w\- ]", "", unescape(heading).strip().lower()).replace(" ", "-")


def address(page):
    return "index.html" if page == DOCS / "README.md" else str(page.relative_to(DOCS).with_suffix(".html"))


def linked(html, page):
    """Makes links to pages lead to pages of the site; links to files that the site lacks become text."""
    def link(match):
        path, hash_, anchor = match[1].partition("#")
        to = (page.parent / path).resolve() if path else page
        if re.match(r"[a-z]+:", match[1]) or not path:
            return match[0]
        if to.suffix == ".md" and DOCS in to.parents:
            return f'<a href="{os.path.relpath(DOCS / address(to), page.parent)}{hash_}{anchor}">{match[2]}</a>'
        return match[0] if DOCS / "pictures" in to.parents else match[2]
    return re.sub(r'<a href="([^"]*)">(.*?)</a>', link, html, flags=re.S)


def make(folder):
    import markdown

    pages = [DOCS / "README.md", *(p for shelf in SHELVES for p in sorted((DOCS / shelf).glob("*.md")))]
    titles = {p: re.match(r"# (.*)", p.read_text())[1].replace("`", "") for p in pages}
    index = []
    for page in pages:
        text = markdown.Markdown(extensions=["tables", "fenced_code", "toc", "sane_lists"], extension_configs={"toc": {"slugify": slug}})
        html = linked(text.convert(page.read_text()), page)
        root = os.path.relpath(DOCS, page.parent)
        links = [f'<a href="{root}/index.html">{escape(titles[pages[0]])}</a>']
        for shelf, name in SHELVES.items():
            links.append(f"<b>{name}</b>")
            links += [f'<a href="{root}/{address(p)}">{escape(titles[p])}</a>' for p in pages if p.parent.name == shelf]
        to = folder / address(page)
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_text(f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{escape(titles[page])} - Driftwright</title><style>{STYLE}</style></head>
<body><nav><input id="search" type="search" placeholder="Search"><div id="found"></div>{"".join(links)}</nav><main>{html}</main>
<script>const ROOT='{root}/'</script><script src="{root}/pages.js"></script><script>{SEARCH}</script></body></html>
""")
        index.append({"title": titles[page], "address": address(page), "text": " ".join(unescape(re.sub(r"<[^>]*>", " ", html)).lower().split())})
    (folder / "pages.js").write_text(f"const PAGES={json.dumps(index, ensure_ascii=False)}\n")
    shutil.copytree(DOCS / "pictures", folder / "pictures", dirs_exist_ok=True, ignore=shutil.ignore_patterns("*.py"))
    return len(pages)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        print(f"{make(Path(sys.argv[1]))} pages in {sys.argv[1]}, from index.html on")
    except ModuleNotFoundError:
        sys.exit("site.py: Debian's package python3-markdown is missing")
