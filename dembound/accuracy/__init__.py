"""Errors of a case's motion by cause, and the cheapest choice that is accurate enough.

`estimate` computes the error of a run, `advise` chooses a case for an error bound, `chart` compares many choices with a
reference. Each kind of body has a `Judge`, which knows its causes of errors and its choices.
"""
