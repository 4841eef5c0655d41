"""Systems that are given as matrices: their terms, and how these change with speed and friction."""
