"""Formulas, set by KaTeX when the site is built: a page needs a style sheet and fonts, and runs nothing."""
import json
import pathlib
import shutil
import subprocess

from docutils import nodes

KATEX = pathlib.Path("/usr/share/javascript/katex")
PROGRAM = """
const katex = require(process.argv[1] + '/katex.js');
require('readline').createInterface({input: process.stdin}).on('line', line => {
  const {text, display} = JSON.parse(line);
  let html = '', error = '';
  try { html = katex.renderToString(text, {displayMode: display, throwOnError: true, strict: 'error'}); } catch (e) { error = String(e); }
  process.stdout.write(JSON.stringify({html, error}) + '\\n');
});
"""


class Formulas:
    """One process of Node for all formulas."""

    def __init__(self):
        self.process = None

    def html(self, text, display):
        if self.process is None:
            self.process = subprocess.Popen(["node", "-e", PROGRAM, str(KATEX)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8")
        self.process.stdin.write(json.dumps({"text": text, "display": display}) + "\n")
        self.process.stdin.flush()
        answer = json.loads(self.process.stdout.readline())
        if answer["error"]:
            raise ValueError(f"{text}: {answer['error']}")
        return answer["html"]

    def inline(self, translator, node):
        translator.body.append(self.html(node.astext(), False))
        raise nodes.SkipNode

    def block(self, translator, node):
        translator.body.append(f'<div class="formula">{self.html(node.astext(), True)}</div>')
        raise nodes.SkipNode

    def end(self, app, error):
        if self.process is not None:
            self.process.stdin.close()
            self.process.wait()
        if error is None:
            folder = pathlib.Path(app.outdir) / "_static/katex"
            folder.mkdir(parents=True, exist_ok=True)
            shutil.copy(KATEX / "katex.min.css", folder)
            shutil.copytree(KATEX / "fonts", folder / "fonts", dirs_exist_ok=True)


def setup(app):
    formulas = Formulas()
    app.add_html_math_renderer("katex", (formulas.inline, None), (formulas.block, None))
    app.config.html_math_renderer = "katex"
    app.add_css_file("katex/katex.min.css")
    app.connect("build-finished", formulas.end)
    return {"parallel_read_safe": False}
