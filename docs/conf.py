"""Settings of the site: `sphinx-build -W docs site` builds it, without a network."""

from dembound.version import __version__

project = "dembound"
author = "the authors of dembound"
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton", "sphinx_design"]
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["zh/_*"]

html_theme = "furo"
html_title = "dembound"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
