"""Pages: printed beside reproduced, participant flow, data quality, parameters, provenance."""
