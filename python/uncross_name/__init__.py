"""Names the mistake of a port: what differs from uncross is held against the same operator with each known mistake in it."""
