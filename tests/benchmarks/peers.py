"""The same work done by other programs, timed in the same run as our kernels.

Each function takes the sizes of the kernel that it is compared with and returns (call, amount of work, its unit); the
call returns what the call of the kernel returns. Raises NotInstalled where the program is absent. CalculiX runs as a
process: its seconds contain reading its input and writing its results.
"""

import shutil
import subprocess
import tempfile
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import numpy as np
import scipy

from pipeline.physics.fem.reference_cells import reference_vertices
from tests.benchmarks import kernels

#: corners of a cube in the order of meshio
_CUBE = reference_vertices("hexahedron")
#: vertices of a cube in the order of scikit-fem, by their numbers in that of meshio
_SKFEM_CORNERS = (0, 4, 3, 1, 7, 5, 2, 6)


class NotInstalled(Exception):
    """The program is not on this machine, or does not start there."""


def _require(package):
    try:
        import_module(package)
    except ImportError:
        raise NotInstalled(package) from None


def tamaas_contact(nodes=256):
    """Tamaas: PolonskyKeerRey, same surface, same remaining gap"""
    _require("tamaas")
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.warning)
    rough, pressure = kernels.rough_surface(nodes), kernels.HALF_SPACE_PRESSURE

    def call():
        model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, 1.0], list(rough.shape))
        model.E, model.nu = kernels.HALF_SPACE
        solver = tamaas.PolonskyKeerRey(model, rough, kernels.TAMAAS_TOLERANCE)
        solver.max_iter = 5000
        solver.solve(pressure)
        return np.array(model.traction)

    return call, nodes**2, "nodes"


def skfem_assembly(sectors=36):
    """scikit-fem: the same forms by asm, ElementVector(ElementHex2)"""
    _require("skfem")
    import skfem
    from skfem.helpers import dot
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = kernels.ring_mesh(sectors, "hexahedron27")
    corners, rank = np.unique(mesh.element[:, :8], return_inverse=True)
    numbered = rank.reshape(-1, 8)[:, _SKFEM_CORNERS]
    grid = skfem.MeshHex(mesh.node[corners].T, numbered.T)
    curved = _curved(skfem.MeshHex2.from_mesh(grid), mesh)
    form = linear_elasticity(*lame_parameters(kernels.YOUNG, kernels.POISSON))

    @skfem.BilinearForm
    def inertia(u, v, w):
        return kernels.DENSITY * dot(u, v)

    def call():
        basis = skfem.Basis(curved, skfem.ElementVector(skfem.ElementHex2()), intorder=5)
        return form.assemble(basis), inertia.assemble(basis)

    return call, 3 * len(mesh.node), "DOF"


def _curved(straight, mesh):
    """The MeshHex2 with every node where ``mesh`` has it, found by where it would be were all edges straight."""
    x, y, z = reference_vertices(mesh.kind).T[..., None]
    a, b, c = _CUBE.T[:, None]
    shape = (a * x + (1 - a) * (1 - x)) * (b * y + (1 - b) * (1 - y)) * (c * z + (1 - c) * (1 - z))
    guess = np.empty_like(mesh.node)
    guess[mesh.element] = shape @ mesh.node[mesh.element[:, :8]]
    distance, nearest = scipy.spatial.cKDTree(guess).query(straight.doflocs.T)
    if distance.max() > 1e-9:
        raise ValueError(f"a node of scikit-fem's mesh is {distance.max():.3g} m from any of ours")
    return replace(straight, doflocs=mesh.node[nearest].T)


def scipy_modes(sectors=48, count=30):
    """SciPy: eigsh, shift-invert, SuperLU"""
    stiffness, mass = kernels.ring_matrices(sectors)
    shift = -(2 * np.pi * kernels.SHIFT) ** 2

    def call():
        square = scipy.sparse.linalg.eigsh(stiffness.tocsc(), count, mass.tocsc(), sigma=shift,
                                           return_eigenvectors=True)[0]
        return np.sqrt(np.sort(square)[kernels.RIGID:]) / (2 * np.pi)

    return call, count, "modes"


def slepc_modes(sectors=48, count=30):
    """SLEPc: Krylov-Schur, shift-invert"""
    _require("slepc4py")
    from petsc4py import PETSc
    from slepc4py import SLEPc

    matrices = [PETSc.Mat().createAIJ(m.shape, csr=(m.indptr.astype(PETSc.IntType), m.indices.astype(PETSc.IntType),
                                                    m.data)) for m in kernels.ring_matrices(sectors)]

    def call():
        solver = SLEPc.EPS().create()
        solver.setOperators(*matrices)
        solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
        solver.setDimensions(count)
        solver.setTarget(-(2 * np.pi * kernels.SHIFT) ** 2)
        solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
        solver.getST().setType(SLEPc.ST.Type.SINVERT)
        solver.solve()
        square = [solver.getEigenvalue(k).real for k in range(count)]
        return np.sqrt(np.sort(square)[kernels.RIGID:]) / (2 * np.pi)

    return call, count, "modes"


def calculix_modes(sectors=48, count=30):
    """CalculiX: *FREQUENCY on C3D20R, as a process"""
    program = shutil.which("ccx")
    if program is None:
        raise NotInstalled("ccx")
    mesh = kernels.ring_mesh(sectors)
    deck = _deck(mesh, count)

    def call():
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "ring.inp").write_text(deck)
            subprocess.run([program, "ring"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            return _frequencies((Path(folder) / "ring.dat").read_text(), count)

    return call, count, "modes"


def _deck(mesh, count):
    """Input of CalculiX, which reads at most 20 characters of a number; the vertices of its bricks are in our order."""
    lines = ["*NODE"] + [f"{k + 1}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(mesh.node)]
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=ALL")
    for k, element in enumerate(mesh.element + 1):
        first, second = element[:15], element[15:]
        lines += [f"{k + 1}, {', '.join(map(str, first))},", ", ".join(map(str, second))]
    lines += ["*MATERIAL, NAME=IRON", "*ELASTIC", f"{kernels.YOUNG:g}, {kernels.POISSON:g}", "*DENSITY",
              f"{kernels.DENSITY:g}", "*SOLID SECTION, ELSET=ALL, MATERIAL=IRON", "*STEP", "*FREQUENCY", f"{count}",
              "*END STEP"]
    return "\n".join(lines) + "\n"


def _frequencies(text, count):
    """Frequencies (Hz) of the table of eigenvalues in a .dat file, without the rigid modes."""
    rows = [line.split() for line in text.splitlines()]
    numbers = [row for row in rows if len(row) == 5 and row[0].isdigit()][:count]
    return np.array([float(row[3]) for row in numbers[kernels.RIGID:]])


def scipy_roots(size=200):
    """SciPy: generalised eigenvalues of the linearised problem, time scaled"""
    mass, damping, stiffness = kernels.quadratic_problem(size)
    zero, unit, scale = np.zeros_like(mass), np.eye(size), np.sqrt(np.linalg.norm(stiffness))

    def call():
        left = np.block([[zero, unit], [-stiffness / scale**2, -damping / scale]])
        roots = scale * scipy.linalg.eigvals(left, np.block([[unit, zero], [zero, mass]]))
        return roots[np.argsort(roots.imag, kind="stable")]

    return call, 1, "problems"


def scipy_superposition(steps=50_000, count=100):
    """SciPy: lfilter of each mode, exact for forces linear in time"""
    angular, damping, forces, force_rows, sensor_rows = kernels.superposition_data(steps, count)
    filters = []
    for omega, drag in zip(angular, damping, strict=True):
        state = np.array([[0.0, 1.0], [-omega**2, -drag]])
        system = (state, np.array([[0.0], [1.0]]), np.eye(2), np.zeros((2, 1)))
        a, b, c, d, _ = scipy.signal.cont2discrete(system, kernels.SUPERPOSITION_STEP, "foh")
        filters.append(scipy.signal.ss2tf(a, b, c, d))

    def call():
        modal = forces @ force_rows
        motion = np.zeros((2, steps, count))
        for k, (numerators, denominator) in enumerate(filters):
            for quantity, numerator in enumerate(numerators):
                motion[quantity, :, k] = scipy.signal.lfilter(numerator, denominator, modal[:, k])
        return tuple(part @ sensor_rows.T for part in motion)

    return call, steps * count, "mode-steps"


def difference(first, second):
    """Largest difference of two results over the largest value; of matrices, that of their Frobenius norms."""
    if isinstance(first, tuple):
        return max(difference(*parts) for parts in zip(first, second, strict=True))
    if scipy.sparse.issparse(first):
        first, second = (scipy.sparse.linalg.norm(matrix) for matrix in (first, second))
    return float(np.abs(np.subtract(first, second)).max() / np.abs(first).max())


#: (peer, kernel whose work it does, largest difference of their results). Wide ones: Tamaas stops at another measure of
#: error; CalculiX integrates bricks at 2 x 2 x 2 points alone; the poles of SciPy's filters lie close to 1
PEERS = ((tamaas_contact, kernels.half_space_contact, 1e-3), (skfem_assembly, kernels.assembly_full, 1e-9),
         (scipy_modes, kernels.modes, 1e-6), (slepc_modes, kernels.modes, 1e-6), (calculix_modes, kernels.modes, 1e-2),
         (scipy_roots, kernels.roots, 1e-9), (scipy_superposition, kernels.superposition, 1e-5))
