"""Signal processing: spectra, pole identification and squeal detection."""
