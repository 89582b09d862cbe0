"""The same code on public real recordings, against numbers that others published."""
