# %% [markdown]
# # Reading a campaign's results
#
# Run it as a script, `python read_results.py results/`, or cell by cell in an editor that knows `# %%`.
# It needs the module `impactid` (pip install impactid-*.whl) and polars or pandas; with matplotlib it also
# draws the map.

# %%
import json
import sys
from pathlib import Path

import impactid

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "results")
results = impactid.Results(folder)

# %% [markdown]
# ## The answer

# %%
print(results.summary)
for name, estimate in results.joint.items():
    print(f"  {name}: {estimate.value} {estimate.interval95} {estimate.status}")
for method, estimates in results.methods.items():
    print(f"  {method}: {', '.join(f'{n} {e.value}' for n, e in estimates.items())}")

# %% [markdown]
# ## The tables

# %%
tables = {
    "records": results.records,
    "impacts": results.impacts,
    "boundaries": results.brackets,
    "budget": results.budget,
}
tables.update({name: results.figure(name) for name in results.figures})
for name, table in tables.items():
    print(f"{name}: {table.shape[0]} rows, columns {', '.join(map(str, table.columns))}")
resolved = json.loads((folder / "campaign.resolved.json").read_text())
print(f"campaign.resolved.json: {len(resolved['records'])} records")

# %% [markdown]
# ## The theory at the identified parameters

# %%
r = results.joint["restitution"].value
beta = results.joint["damping_ratio"].value
motion = impactid.simulate(eta=0.9, rho=0.5, restitution=r, damping_ratio=beta, skip_periods=100)
edge = impactid.boundary("s2", restitution=r, damping_ratio=beta, eta=[1.0, 1.1, 1.2])
print(f"simulated: {len(motion.x)} samples, {len(motion.impacts['closing_speed_before'])} impacts")
print(f"z = 1 ends at rho = {edge.rho} for eta = {edge.eta}")

# %% [markdown]
# ## The map

# %%
try:
    axes = results.plot_map()
except ImportError as error:
    print(error)
    sys.exit(0)
axes.figure.savefig(folder / "records.png")
print(f"written: {folder / 'records.png'}")
