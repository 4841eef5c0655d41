"""Features extracted from recordings: poles, limit cycles and worn surfaces."""
