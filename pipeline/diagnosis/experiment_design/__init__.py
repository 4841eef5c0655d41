"""Which recording to make next: the one that tells the remaining candidates apart."""
