"""The result of a diagnosis as a product and as files."""
