"""What a product was computed with: packages, kernels of linear algebra, commit of the code."""

import subprocess
from pathlib import Path

_PACKAGES = ("numpy", "scipy", "scikit-fem", "exudyn", "h5py", "numba", "pypardiso", "SurfaceTopography", "pyvista")


def packages():
    """{name: version} of the packages that results depend on, where they are installed."""
    from importlib import metadata

    versions = {}
    for name in _PACKAGES:
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return versions


def kernels():
    """Linear algebra libraries that are loaded, each with the processor kernel that it uses."""
    from threadpoolctl import threadpool_info

    loaded = {f"{library['internal_api']} {library.get('architecture') or ''}".strip() for library in threadpool_info()
              if library["user_api"] == "blas"}
    return sorted(loaded)


def git_commit():
    """Commit of the checkout that holds this code, with '+' when it was changed; '' outside one."""
    here = Path(__file__).parent
    try:
        commit = subprocess.run(["git", "describe", "--always", "--abbrev=40", "--dirty=+", "--exclude=*"], cwd=here,
                                capture_output=True, text=True, check=True, timeout=10)
    except (OSError, subprocess.SubprocessError):
        return ""
    return commit.stdout.strip()
