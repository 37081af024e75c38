"""The C interface from the words of include/uncross.h itself: ```{c-header} path```.

The header has one form: a comment, then what it is about, up to the next empty line; `/* --- name --- */` begins a section. Doxygen
takes other comments than these, and one comment for one function only.
"""
import os
import pathlib
import re

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.util.docutils import SphinxDirective

ROOT = pathlib.Path(os.environ["SITE_ROOT"])


# What is code in a sentence of the header.
CODE = re.compile(r"(?<![\w`])(uncross_\w+(?:\(\))?|UNCROSS_\w+|\*error|[\w*]*\[[\w .+]+\](?:\[\d\])?)(?!`)")


def words(comment):
    """A comment without its frame, for Markdown: each name stays as it is written."""
    text = re.sub(r"^/\*+ ?|\s*\*+/$", "", comment.strip())
    text = CODE.sub(r"`\1`", re.sub(r"\n\s*\* ?", "\n", text).strip())
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if part.startswith("`") else re.sub(r"([*_<$])", r"\\\1", part) for part in parts)


def declarations(code):
    """Each declaration of a block: up to its semicolon outside braces, or a line of the preprocessor."""
    depth, begun = 0, ""
    for line in code.split("\n"):
        begun += line + "\n"
        depth += line.count("{") - line.count("}")
        if depth == 0 and (line.rstrip().endswith(";") or line.startswith("#")):
            yield begun.strip()
            begun = ""


def members(code, kind):
    """Rows of a table: each member of a struct or enum, with its comment."""
    inside = code[code.index("{") + 1:code.rindex("}")]
    for match in re.finditer(r"^\s*([^/\n]+?)[;,]?[ \t]*(?:/\*(.*?)\*/)?[ \t]*$", inside, re.M | re.S):
        yield f"| `{match[1].strip()}` | {words(match[2] or '')} |".replace("\n", " ")


def described(code):
    """A declaration as an object of Sphinx's domain of C, and what comes below it."""
    code = code.replace("UNCROSS_API ", "")
    flat = " ".join(code.split())
    if match := re.match(r"#define (\w+)", code):
        return "macro", match[1], [f"`{flat}`"]
    if match := re.match(r"enum (\w+) \{", code):
        return "enum", match[1], ["| | |", "| --- | --- |", *members(code, "enum")]
    if match := re.match(r"typedef struct (\w+) \{", code):
        return "struct", match[1], ["| | |", "| --- | --- |", *members(code, "struct")]
    if match := re.match(r"typedef struct \w+ (\w+);", code):
        return "type", match[1], []
    if flat.startswith("typedef"):
        return "type", flat.rstrip(";").replace("typedef ", "", 1), []
    return "function", flat.rstrip(";"), []


class Header(SphinxDirective):
    """Sections, and in each what is declared, below its comment."""
    required_arguments = 1

    def run(self):
        path = ROOT / self.arguments[0]
        self.env.note_dependency(str(path))
        text = path.read_text(encoding="ascii")
        head = re.match(r"/\*.*?\*/", text, re.S)[0]
        lines = ["## For all functions", "", words(head), ""]
        body = text[text.index("/* --- "):]
        body = re.sub(r"#ifdef __cplusplus.*", "", body, flags=re.S)
        for section in re.split(r"^/\* --- ", body, flags=re.M)[1:]:
            name, _, rest = section.partition(" ---")
            lines += [f"## {name.capitalize()}", ""]
            for block in re.split(r"\n\n+(?! \*)", rest.partition("\n")[2].strip("\n")):
                comment = re.match(r"/\*.*?\*/", block, re.S)
                declared = list(declarations(block[comment.end():] if comment else block))
                for number, code in enumerate(declared):
                    kind, signature, below = described(code)
                    lines += [f"```{{c:{kind}}} {signature}", ""]
                    if comment and number == len(declared) - 1:
                        lines += [words(comment[0]), ""]
                    lines += [*below, "```", ""]
        holder = nodes.container()
        self.state.nested_parse(StringList("\n".join(lines).split("\n"), source=self.arguments[0]), self.content_offset, holder, match_titles=True)
        return holder.children  # sections have gone to the page itself


def setup(app):
    app.add_directive("c-header", Header)
    return {"parallel_read_safe": True}
