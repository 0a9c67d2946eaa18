"""Every link between the pages leads to a file, and to a heading in it.

    links.py CHECKOUT
"""

import pathlib
import re
import sys


def anchors(page):
    """The anchors of a page's headings, as GitHub makes them."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    found = set()
    for heading in re.findall(r"^#+ (.+)$", text, re.MULTILINE):
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        number = 0
        while (numbered := anchor + (f"-{number}" if number else "")) in found:
            number += 1
        found.add(numbered)
    return found


def main():
    checkout = pathlib.Path(sys.argv[1])
    pages = [*checkout.glob("*.md"), *checkout.glob("docs/*.md")]
    broken = []
    for page in pages:
        for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
            if re.match(r"https?:", target):
                continue
            name, _, anchor = target.partition("#")
            other = (page.parent / name) if name else page
            if not other.exists() or (anchor and anchor not in anchors(other)):
                broken.append(f"{page.relative_to(checkout)}: {target}")
    assert len(pages) > 20, f"only {len(pages)} pages"
    print("\n".join(broken))
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
