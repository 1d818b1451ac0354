//! An atlas over the ranks of an MPI run: each computes one part, the first puts them together, so
//! that the files are those of one process, byte for byte.

use ::mpi::traits::{Communicator, Destination, Source};

use super::atlas_part::computed;
use super::merge::whole;
use super::theory::OutArgs;
use super::{Exit, Failure, Verbosity};
use impact_oscillator::atlas::shard::AtlasPart;
use impact_workbench::theory::Study;
use impact_workbench::theory::plan::RegionsPlan;

/// What a rank sends to the first: its part as JSON, or why it has none.
type PartResult = Result<AtlasPart, String>;

/// Compute this rank's part; the first rank gathers all of them and writes the atlas.
///
/// # Errors
/// [`Failure`] where MPI does not start, a rank has no part, or a file cannot be written.
pub fn run(
    study: &Study,
    plan: &RegionsPlan,
    out: &OutArgs,
    verbosity: Verbosity,
) -> Result<Exit, Failure> {
    let start_it = "start the program with mpirun, and only once in a process";
    let universe =
        ::mpi::initialize().ok_or_else(|| Failure::new("MPI does not start", start_it))?;
    let world = universe.world();
    let (rank, size) = (world.rank(), world.size());
    let own = computed(
        study,
        plan,
        rank.unsigned_abs() as usize,
        size.unsigned_abs() as usize,
    );
    if rank != 0 {
        let part: PartResult = own.as_ref().map(Clone::clone).map_err(Failure::text);
        let bytes = serde_json::to_vec(&part).unwrap_or_default();
        world.process_at_rank(0).send(&bytes[..]);
        return own.map(|_| Exit::Done);
    }
    // every rank's message is received even where this one failed, so that none waits without end
    let others: Vec<PartResult> = (1..size)
        .map(|k| {
            let (bytes, _) = world.process_at_rank(k).receive_vec::<u8>();
            serde_json::from_slice(&bytes).unwrap_or_else(|e| Err(e.to_string()))
        })
        .collect();
    let mut parts = vec![own?];
    for (part, k) in others.into_iter().zip(1..) {
        parts.push(part.map_err(|e| {
            let remedy = "look at that rank's own message; give --kernel where machines differ";
            Failure::new(format!("rank {k}: {e}"), remedy)
        })?);
    }
    whole(&parts, out, verbosity)
}
