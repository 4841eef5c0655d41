"""Systems: geometry, materials and joints, each value with its origin."""
