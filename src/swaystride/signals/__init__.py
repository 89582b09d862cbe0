"""Signals that know no body: filters, gaps, orientation."""
