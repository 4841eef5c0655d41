"""Large systems given as matrices: their terms over speed and friction, their roots without reduction."""
