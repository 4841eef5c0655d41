"""One thread for each process of the tests, as for each of the program: more would wait for each other."""

import os

from pipeline.environment import ONE_THREAD

os.environ.update(ONE_THREAD)       # before anything loads linear algebra
