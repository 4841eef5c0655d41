"""Published lists of modes and squeal frequencies as evidence."""
