"""Simulated bodies, sensors and cohorts: raw files in vendor formats with known truth."""
