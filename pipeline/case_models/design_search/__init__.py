"""Search over a declared design space: its values, the searches from several starts, and what they leave out."""
