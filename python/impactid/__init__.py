"""impactid from Python: run the program, read its results as frames, theory as numpy arrays.

The wheel carries the program itself; everything here starts it and reads what it wrote.

    import impactid

    results = impactid.run("campaign.toml", "results")
    print(results.joint["restitution"])        # value, interval95, status
    results.records                             # a polars or pandas frame
    results.plot_map()                          # with matplotlib
    impactid.simulate(eta=0.9, rho=0.5, restitution=0.6).x
    impactid.boundary("s2", restitution=0.6, eta=[1.0, 1.1, 1.2]).rho

Quantities are SI; of the theory they are dimensionless, as in docs/theory.md.
"""

from ._estimate import Estimate
from ._program import ProgramError, ProgramMissing, program, version
from ._results import Results, run
from ._theory import Boundary, Motion, boundary, simulate
from ._waveform import Signal, Waveform

__all__ = [
    "Boundary",
    "Estimate",
    "Motion",
    "ProgramError",
    "ProgramMissing",
    "Results",
    "Signal",
    "Waveform",
    "boundary",
    "program",
    "run",
    "simulate",
    "version",
]
