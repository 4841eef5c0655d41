"""Fan-out of independent tasks: this process, local processes, or a Dask cluster. Same bits each way."""

from pipeline.contract.executors.cluster import DaskCluster
from pipeline.contract.executors.local import InProcess, LocalProcesses, run_task

__all__ = ["DaskCluster", "InProcess", "LocalProcesses", "choose", "run_task"]


def choose(workers, scheduler):
    """The executor that the command line asks for."""
    if scheduler:
        return DaskCluster(scheduler)
    return LocalProcesses(workers) if workers > 1 else InProcess()
