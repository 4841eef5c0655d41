"""Tables of instruments: heads, units, time stamps, rounded times, matrices."""
