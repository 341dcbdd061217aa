"""Foreign files: tricks of an adversary, and the limits that stop them."""
