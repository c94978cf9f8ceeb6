"""Results for people who do not have dembound: a page that holds everything it shows, and movies."""
