"""A smaller scene stepped in place of a case: one row of identical ones."""
