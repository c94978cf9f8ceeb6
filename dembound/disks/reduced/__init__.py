"""Smaller scenes stepped in place of a case: one row of identical ones, halves of a symmetric one."""
