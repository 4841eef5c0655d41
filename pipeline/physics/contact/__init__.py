"""Contact between bodies: groups of contact points and static preload."""
