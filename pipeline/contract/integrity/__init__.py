"""Whether files are as they were written: checksums behind products, and what was seen of them before."""
