"""Processes that end with their parent, however it ended.

``python -m pipeline.contract.following PARENT MODULE ARGUMENTS`` runs a module as ``python -m MODULE ARGUMENTS`` does,
until the process with the id PARENT is no longer its parent.
"""

import os
import runpy
import sys
import threading
import time

#: seconds between two checks of the parent
_PERIOD = 0.5


def follow(parent):
    """End this process once the process with the id ``parent`` is no longer its parent."""

    def watch():
        while os.getppid() == parent:
            time.sleep(_PERIOD)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


if __name__ == "__main__":
    follow(int(sys.argv[1]))
    del sys.argv[:2]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
