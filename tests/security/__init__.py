"""What somebody else's files may do: tricks of an adversary, and the limits that hold them."""
