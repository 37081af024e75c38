"""Links from pages to files of the repository that are no pages: each file gets a page of its own below files/, with its lines.

A picture or a file of bytes is copied. A folder's page lists what is in it. Pages of files are made outside of the search, which is for prose.
"""
import os
import pathlib
import re
import shutil
import subprocess
from urllib.parse import unquote

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx import addnodes
from sphinx.util import logging

ROOT = pathlib.Path(os.environ["SITE_ROOT"])
# Inline code that is the path of such a file is a link, too.
SHOWN = ("scenes/", "examples/", "docs/exercises/")
# A source that the site has as a running page, made by `make live`.
RUNNING = {"live/index.html"}
# The text of a link that is a name of a file: on the site the title of its page says more.
FILE_NAME = re.compile(r"[\w./-]+\.md")
LARGEST = 300_000  # bytes that are shown as lines

tell = logging.getLogger(__name__)


def tracked():
    """The repository's files, or all files of an unpacked archive."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode == 0:
        return set(listed.stdout.splitlines())
    return {str(p.relative_to(ROOT)) for p in ROOT.rglob("*") if p.is_file() and p.relative_to(ROOT).parts[0] != "build"}


def is_text(path):
    content = path.read_bytes()
    return b"\0" not in content and len(content) <= LARGEST


class Links:
    """Which files pages link to."""

    def __init__(self, app):
        self.app, self.files, self.wanted = app, tracked(), set()
        self.folders = {str(parent) for name in self.files for parent in pathlib.PurePath(name).parents}

    def named_place(self, docname, target, place):
        """The link to a page that names the place itself, <a id="place">, which MyST does not know."""
        if place and target.endswith(".md") and target in self.files and f'<a id="{place}">' in (ROOT / target).read_text(encoding="utf-8"):
            return self.app.builder.get_relative_uri(docname, target[:-len(".md")])
        return None

    def address(self, docname, target):
        """The link from a page to a path of the repository; None if the path is a page, or is not there."""
        if self.app.env.project.path2doc(target) in self.app.env.found_docs and target.endswith(".md"):
            return None
        if target not in self.files and target not in self.folders:
            return None
        if target in RUNNING:
            return "../" * docname.count("/") + target
        self.wanted.add(target)
        if target in self.files and not is_text(ROOT / target):
            return "../" * docname.count("/") + "files/" + target
        return self.app.builder.get_relative_uri(docname, f"files/{target}" if target in self.files else f"files/{target}/index")

    def take(self, app, doctree):
        docname = app.env.docname
        folder = os.path.dirname(docname)
        for node in list(doctree.findall(lambda n: isinstance(n, (addnodes.pending_xref, addnodes.download_reference)) and n.get("reftype") == "myst")):
            path, _, place = unquote(node["reftarget"]).partition("#")
            if not path:
                continue
            target = os.path.normpath(os.path.join(folder, path))
            address = self.named_place(docname, target, place) or self.address(docname, target)
            if address:
                node.replace_self(nodes.reference("", "", *node.children, refuri=address + (f"#{place}" if place else ""), internal=True))
            elif isinstance(node, addnodes.download_reference):
                tell.warning("a link to a file that the repository does not have: %s", target, location=node)
            elif FILE_NAME.fullmatch(node.astext()):
                node["refexplicit"] = False  # MyST then writes the title
        for node in list(doctree.findall(nodes.literal)):
            if isinstance(node.parent, (nodes.reference, nodes.inline, nodes.title)):
                continue
            text = node.astext()
            if text.startswith("live/#"):
                address = "../" * docname.count("/") + text.replace("live/#", "live/index.html#", 1)
            elif text.startswith(SHOWN) and text.rstrip("/") in self.files | self.folders:
                address = self.address(docname, text.rstrip("/"))
            else:
                continue
            if address:
                node.replace_self(nodes.reference("", "", node.deepcopy(), refuri=address, internal=True))

    def pages(self, app):
        shown = HtmlFormatter(linespans="L")
        waiting = sorted(self.wanted)
        done = set()
        while waiting:
            name = waiting.pop()
            if name in done:
                continue
            done.add(name)
            path = ROOT / name
            if name in self.folders:
                # What a folder holds is listed; only what pages link to has a page.
                inside = sorted({f[len(name) + 1:].split("/")[0] + ("/" if "/" in f[len(name) + 1:] else "") for f in self.files if f.startswith(name + "/")})
                items = []
                for item in inside:
                    page = f"{name}/{item}"
                    if item.endswith("/"):
                        items.append(f"<li>{item}</li>")
                    elif page.endswith(".md") and page[:-3] in app.env.found_docs:
                        items.append(f'<li><a href="{app.builder.get_relative_uri(f"files/{name}/index", page[:-3])}">{item}</a></li>')
                    else:
                        waiting.append(page)
                        items.append(f'<li><a href="{item}{".html" if is_text(path / item) else ""}">{item}</a></li>')
                yield f"files/{name}/index", {"title": name, "body": f"<h1>{name}</h1>\n<ul>{''.join(items)}</ul>"}, "page.html"
            elif not is_text(path):
                copy = pathlib.Path(app.outdir) / "files" / name
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, copy)
            else:
                try:
                    lexer = get_lexer_for_filename(name)
                except ClassNotFound:
                    lexer = TextLexer()
                body = highlight(path.read_text(encoding="utf-8", errors="replace"), lexer, shown)
                yield f"files/{name}", {"title": name, "body": f"<h1>{name}</h1>\n{body}"}, "page.html"


def begin(app):
    links = Links(app)
    app.connect("doctree-read", links.take, priority=400)  # before Sphinx collects what is to be downloaded
    app.connect("html-collect-pages", links.pages)


def setup(app):
    app.connect("builder-inited", begin)
    return {"parallel_read_safe": False}
