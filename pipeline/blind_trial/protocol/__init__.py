"""The concealed trial: sets of cases, made and sealed, solved without their truth, scored once and shown."""
