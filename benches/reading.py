"""Files for the benchmark of reading, and what the field's Python readers make of them.

    python benches/reading.py DIR [IMPACTID]

makes in DIR 200 records of 16 channels and 2,000 samples in every format whose Python library is
installed, reads each with that library on one core (the best of five, MB/s of samples of eight
bytes), and, where IMPACTID names the program, with `impactid --threads 1 inspect --json`, which
reads every sample and also computes its statistics. `cargo bench --bench reading -- DIR` measures
the reading alone.
"""

import importlib
import os
import subprocess
import sys
import time

RECORDS, CHANNELS, SAMPLES = 200, 16, 2000
BYTES = 8 * RECORDS * CHANNELS * SAMPLES


def library(name):
    try:
        return importlib.import_module(name)
    except ImportError:
        print(f"skipped: {name} is not installed")
        return None


def best(read):
    times = []
    for _ in range(5):
        begin = time.perf_counter()
        read()
        times.append(time.perf_counter() - begin)
    return BYTES / min(times) / 1e6


def signals(np):
    t = np.arange(SAMPLES)[:, None] + np.arange(CHANNELS)
    noise = np.random.default_rng(1)
    return [np.sin(0.01 * t) + 1e-3 * noise.random((SAMPLES, CHANNELS)) for _ in range(RECORDS)]


def hdf5(folder, records, h5py):
    packings = {"contiguous": {}, "gzip": {"compression": "gzip"},
                "gzip_shuffle": {"compression": "gzip", "shuffle": True}}
    for name, packing in packings.items():
        path = os.path.join(folder, f"{name}.h5")
        with h5py.File(path, "w") as file:
            for i, record in enumerate(records):
                file.create_dataset(f"r{i:03}", data=record, **packing).attrs["sample_rate_hz"] = 2000.0

        def read(path=path):
            with h5py.File(path) as file:
                return [file[key][()] for key in file]
        yield f"{name}.h5", best(read)


def mat(folder, records, scipy_io):
    for name, packed in [("plain", False), ("packed", True)]:
        path = os.path.join(folder, f"{name}.mat")
        variables = {f"r{i:03}": record for i, record in enumerate(records)}
        scipy_io.savemat(path, variables, do_compression=packed)
        yield f"{name}.mat", best(lambda path=path: scipy_io.loadmat(path))


def tdms(folder, records, nptdms):
    path = os.path.join(folder, "one.tdms")
    with nptdms.TdmsWriter(path) as writer:
        for i, record in enumerate(records):
            writer.write_segment([
                nptdms.ChannelObject(f"r{i:03}", f"c{c}", record[:, c], {"wf_increment": 0.0005})
                for c in range(CHANNELS)])

    def read():
        return [c[:] for g in nptdms.TdmsFile.read(path).groups() for c in g.channels()]
    yield "one.tdms", best(read)


def csv(folder, records, polars):
    where = os.path.join(folder, "tables.csv")
    os.makedirs(where, exist_ok=True)
    paths = [os.path.join(where, f"r{i:03}.csv") for i in range(RECORDS)]
    for path, record in zip(paths, records):
        polars.DataFrame(record, schema=[f"c{c} [V]" for c in range(CHANNELS)]).write_csv(path)
    yield "tables.csv", best(lambda: [polars.read_csv(path) for path in paths])


def uff_record(pyuff, np, path, record, binary):
    """One record by pyuff, in a file of its own: pyuff scans a file again for every set added."""
    file = pyuff.UFF(path)
    for c in range(CHANNELS):
        file.write_sets(pyuff.prepare_58(
            binary=binary, func_type=1, rsp_node=c + 1, rsp_dir=1, ref_node=0, ref_dir=0,
            x=np.arange(SAMPLES) * 0.0005, data=record[:, c], id1=f"c{c}",
            abscissa_spacing=1, abscissa_min=0.0, abscissa_inc=0.0005,
            abscissa_spec_data_type=17, ordinate_spec_data_type=12, orddenom_spec_data_type=0,
            z_axis_spec_data_type=0), "add")


def uff(folder, records, pyuff):
    import numpy as np
    for name, binary in [("binary", 1), ("ascii", 0)]:
        path, part = os.path.join(folder, f"{name}.uff"), os.path.join(folder, "part.tmp")
        # pyuff reads text slowly: a tenth of the records
        count = RECORDS if binary else RECORDS // 10
        with open(path, "wb") as whole:
            for record in records[:count]:
                uff_record(pyuff, np, part, record, binary)
                with open(part, "rb") as written:
                    whole.write(written.read())
                os.remove(part)
        sets = pyuff.UFF(path).read_sets()
        assert len(sets) == count * CHANNELS
        read_back = np.stack([s["data"] for s in sets[:CHANNELS]], axis=1)
        assert np.allclose(read_back, records[0], rtol=0, atol=1e-11)
        yield f"{name}.uff", best(lambda path=path: pyuff.UFF(path).read_sets()) * count / RECORDS


def own(program, path):
    import json
    paths = [os.path.join(path, f) for f in sorted(os.listdir(path))] if os.path.isdir(path) else [path]
    command = [program, "--threads", "1", "inspect", "--json", *paths]
    listed = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    share = sum(c["samples"] for c in listed) * 8 / BYTES
    run = lambda: subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
    return best(run) * share


def main():
    np = library("numpy")
    if np is None or len(sys.argv) < 2:
        sys.exit(__doc__)
    folder, program = sys.argv[1], (sys.argv[2:] or [None])[0]
    os.makedirs(folder, exist_ok=True)
    records = signals(np)
    makers = [("h5py", hdf5), ("scipy.io", mat), ("nptdms", tdms), ("polars", csv), ("pyuff", uff)]
    print(f"{'file':20} {'reader':10} {'MB/s':>8} {'inspect MB/s':>14}")
    for name, make in makers:
        module = library(name)
        for file, speed in make(folder, records, module) if module else []:
            mine = f"{own(program, os.path.join(folder, file)):14.0f}" if program else ""
            print(f"{file:20} {name:10} {speed:8.0f} {mine}", flush=True)


if __name__ == "__main__":
    main()
