#!/usr/bin/env python3
"""Every link of a page to another file of the project, or to a heading of one, leads there: links_test.py PROJECT"""
import pathlib
import re
import sys


def anchors(page):
    """The anchors of its headings, as GitHub and Forgejo make them: lower case, blanks to hyphens, no other signs."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S)
    return {re.sub(r"[^\w\- ]", "", h.strip().lower()).replace(" ", "-") for h in re.findall(r"^#+ (.*)$", text, flags=re.M)}


def broken(project):
    pages = [p for p in project.rglob("*.md") if not {"build", "node_modules", ".git", "results"} & set(p.relative_to(project).parts)]
    assert len(pages) > 40, f"only {len(pages)} pages under {project}"
    for page in pages:
        for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = link.partition("#")
            to = (page.parent / path).resolve() if path else page
            if not to.exists():
                yield f"{page.relative_to(project)}: {link} is not there"
            elif anchor and anchor not in anchors(to):
                yield f"{page.relative_to(project)}: {link}: no such heading"


if __name__ == "__main__":
    found = list(broken(pathlib.Path(sys.argv[1]).resolve()))
    print("\n".join(found))
    sys.exit(1 if found else 0)
