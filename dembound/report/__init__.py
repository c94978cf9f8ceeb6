"""Results for people without dembound: self-contained pages, and movies."""
