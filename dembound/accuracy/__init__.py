"""How wrong the motion of a case is, by which causes, and the cheapest choice that is accurate enough.

`estimate` tells it of a run, `advise` chooses a case for a bound, `chart` runs many choices beside a reference. Each
kind of body has a `Judge`, which knows its causes of errors and its choices.
"""
