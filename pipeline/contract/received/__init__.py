"""What came from elsewhere: names, files, HDF5, YAML and quantities, each checked in one place before it is used."""
