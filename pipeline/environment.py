"""What fixes the bits: one thread per process and one code path of MKL, set before numpy is loaded."""

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1",
              "MKL_CBWR": "AUTO"}
