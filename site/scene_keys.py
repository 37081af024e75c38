"""Keys of scenes, as docs/scene.md lists them, for the search and the index: `crossing.rule` is found by its name. Each cell gets its column
as a class, so that a phone shows a key as a card (site.css)."""
import re

from docutils import nodes
from sphinx.util.nodes import make_id

PAGE = "docs/scene"


def note(app, doctree):
    if app.env.docname != PAGE:
        return
    standard = app.env.get_domain("std")
    for table in doctree.findall(nodes.table):
        heads = [entry.astext() for entry in table.next_node(nodes.thead).findall(nodes.entry)]
        if heads[:2] != ["key", "allowed"]:
            continue
        table["classes"].append("keys")
        # Sections of one key may share a table: "observe.conserved, temperature".
        first, *others = table.parent.next_node(nodes.title).astext().split(", ")
        sections = [first] + [f"{first.rpartition('.')[0]}.{other}" for other in others]
        for row in table.next_node(nodes.tbody).findall(nodes.row):
            key = row.next_node(nodes.literal)
            for head, entry in zip(heads, row.findall(nodes.entry)):
                entry["classes"].append(f"of-{head}" if entry.astext() else "of-nothing")
            place = row  # the row; where sections share it, its first cell has the other names
            for section in sections:
                name = key.astext() if section == "Top level" else f"{section}.{key.astext()}"
                row_id = make_id(app.env, doctree, "key", re.sub(r"[._]", "-", name))
                place["ids"].append(row_id)
                place = key.parent
                standard.note_object("key", name, row_id, location=key)


def setup(app):
    app.add_object_type("key", "key", "single: %s (key of a scene)", objname="key of a scene")
    app.connect("doctree-read", note)
    return {"parallel_read_safe": True}
