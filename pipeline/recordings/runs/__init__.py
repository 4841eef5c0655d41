"""From channels of files to runs: even grids, one clock for several files, and what is told of them."""
