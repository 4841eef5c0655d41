"""A brake with finer meshes and contact, without modes or reduction, beside the one that a case states."""
