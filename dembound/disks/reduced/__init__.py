"""A smaller scene stepped in place of a case: one of several identical rows."""
