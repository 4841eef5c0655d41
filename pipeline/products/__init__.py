"""Every product that crosses a stage boundary. These pages are the file-format reference.

Conventions: SI units; cylindrical axes of the disc, z along its axis; the disc turns about +z.
Side 'outer' (fingers) is z > 0, side 'inner' (piston) is z < 0. At a contact the normal points from
the disc into the pad, the tangent along the sliding velocity of the disc, the lateral direction
radially outwards. A relative displacement is pad minus disc: positive normal opens the contact.
"""

from pipeline.products.beams import BeamGeometry, BeamOnBeam, MotionScatter
from pipeline.products.bodies import Body, Incidence, MeshTie, ModelUpdate
from pipeline.products.diagnosis import (
    Bench,
    BenchRun,
    BenchStops,
    DiagnosedRun,
    Diagnosis,
    Effects,
    Follows,
    LatentForce,
    LatentPrediction,
    LineEvidence,
    Located,
    SquealCheck,
)
from pipeline.products.friction import (
    FrictionDescriptions,
    FrictionMap,
    FrictionOverTemperature,
    FrictionUpdate,
    InterfaceLaw,
    MicroFriction,
)
from pipeline.products.lumped import Lumped
from pipeline.products.motion import ComplexModes, Convergence, Multibody, Probability, Transient
from pipeline.products.pages import Comparison, Report
from pipeline.products.pin_on_disc import LockIn, PinOnDisc
from pipeline.products.predicted_squeal import Countermeasures, LimitCycle, NoiseMatrix, Sensitivities
from pipeline.products.recording import (
    Channel,
    Condition,
    FileClock,
    FrequencyResponse,
    Lines,
    MeasuredFriction,
    MeasuredModes,
    ModalTest,
    Recording,
    ResponseFunctions,
    Run,
    TestModes,
    TestResponses,
    Topography,
)
from pipeline.products.rupture import Rupture
from pipeline.products.sliding import ReducedModel
from pipeline.products.sound import (
    Excerpt,
    NoiseEvents,
    OccurrenceMap,
    Orders,
    OrderSpectra,
    Response,
    Spectrogram,
    Squeal,
)
from pipeline.products.structure import Structure
from pipeline.products.surfaces import Surface
from pipeline.products.systems.design_search import DesignSearch
from pipeline.products.systems.matrices import Matrices, MatrixModes, MatrixTerm, RootsOfMatrices

__all__ = ["BeamGeometry", "BeamOnBeam", "Bench", "BenchRun", "BenchStops", "Body", "Channel", "Comparison", "ComplexModes",
           "Condition", "Convergence", "Countermeasures", "DesignSearch", "DiagnosedRun", "Diagnosis", "Effects", "Excerpt", "FileClock", "Follows", "FrequencyResponse", "FrictionDescriptions",
           "FrictionMap", "FrictionOverTemperature", "FrictionUpdate", "Incidence", "MeshTie", "InterfaceLaw", "LatentForce", "LatentPrediction", "LimitCycle", "LineEvidence", "Lines", "Located", "LockIn",
           "Lumped", "Matrices", "MatrixModes", "MatrixTerm", "MeasuredFriction", "MeasuredModes", "MicroFriction", "ModalTest", "ModelUpdate", "MotionScatter", "Multibody", "NoiseEvents", "NoiseMatrix", "OccurrenceMap", "OrderSpectra", "Orders", "PinOnDisc", "Probability",
           "Recording", "ReducedModel", "Report", "Response", "ResponseFunctions", "RootsOfMatrices", "Run", "Rupture", "Sensitivities", "Spectrogram", "Squeal", "SquealCheck", "Structure", "Surface", "TestModes", "TestResponses", "Topography",
           "Transient"]
