"""Settings of the documentation's site; docs/site/stage.py lays out what it reads."""

import os

project = "snare"
author = "the authors of snare"
extensions = ["myst_parser", "sphinx.ext.mathjax"]
if os.environ.get("SNARE_PYTHON_REFERENCE"):
    extensions += ["sphinx.ext.autodoc"]
    autodoc_typehints = "none"  # the signatures of the stubs stand in the docstrings
    autodoc_member_order = "bysource"
else:
    tags.add("without_python")  # noqa: F821: Sphinx puts `tags` there

source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
root_doc = "index"
exclude_patterns = ["extra", "_static"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # a page may begin below its first level
html_theme = "sphinx_rtd_theme"
html_static_path = ["_static"]
html_extra_path = ["extra"]
html_show_sourcelink = False
html_copy_source = False
# Formulas are drawn by a MathJax that stands in the site: no page asks the net for anything.
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"
mathjax2_config = {"showMathMenu": False, "messageStyle": "none",
                   "tex2jax": {"ignoreClass": "tex2jax_ignore|mathjax_ignore", "processClass": "tex2jax_process|mathjax_process|math"}}
myst_update_mathjax = False  # it would speak to MathJax 3
highlight_language = "none"


def setup(app):
    """Tables of readings stand as they are."""
    from pygments.lexers.special import TextLexer

    app.add_lexer("csv", TextLexer)
