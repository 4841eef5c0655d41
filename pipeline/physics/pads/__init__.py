"""Flexible pads on a disc: multibody model, contact patches and pad motion."""
