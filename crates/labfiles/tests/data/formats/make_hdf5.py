"""Makes the HDF5 files of this folder with h5py (3.16, HDF5 2.0): python make_hdf5.py"""
import h5py
import numpy as np

n = 50
t = np.arange(n) / 2000.0
x = np.sin(2 * np.pi * 12.6 * t)
y = np.cos(2 * np.pi * 12.6 * t)

# One table a record, 12-bit counts with scale and offset, chunked, gzip and shuffle.
with h5py.File("tables_int16_gzip.h5", "w", libver="earliest") as f:
    f.attrs["channels"] = ["drive", "velocity_x", "velocity_y"]
    f.attrs["units"] = ["V", "mm/s", "mm/s"]
    f.attrs["sample_rate_hz"] = 2000.0
    for k in (1, 2, 10):
        counts = np.stack([np.round(1000 * k * s / 10) for s in (x, y, -x)], axis=1).astype("<i2")
        d = f.create_dataset(f"run{k}", data=counts, chunks=(16, 3), compression="gzip", shuffle=True)
        d.attrs["scale"] = [0.005, 0.5, 0.25]
        d.attrs["offset"] = 1.0
        d.attrs["clearance_m"] = 1e-3 * k
        d.attrs["sweep"] = "up"

# A group a record, one array a channel, big endian and mixed types, a time axis.
with h5py.File("groups_mixed_types.h5", "w") as f:
    for k in (1, 2):
        g = f.create_group(f"set/rec{k:02d}")
        g.attrs["drive_frequency_hz"] = np.float32(12.5)
        g["time"] = t
        g["time"].attrs["units"] = "s"
        g.create_dataset("x", data=x.astype(">f4"), chunks=(7,), compression="lzf")
        g["x"].attrs["unit"] = "mm/s"
        g.create_dataset("contact", data=(x > 0.5))
        g.create_dataset("count", data=np.arange(n, dtype=">u2"), chunks=(20,), fletcher32=True)
        g.create_dataset("z", data=x + 1j * y)
        g.create_dataset("half", data=y.astype("<f2"))
        g["operator"] = "Novák"
        g["gain"] = 2.5

# Channels in rows, names in a comma-separated attribute; a table beside its time axis.
with h5py.File("rows_and_time.h5", "w") as f:
    d = f.create_dataset("wide", data=np.stack([x, y]))
    d.attrs["names"] = "vx, vy"
    d.attrs["dt"] = 0.0005
    g = f.create_group("timed")
    g["t"] = t
    g["data"] = np.stack([x, y], axis=1)
    g["names"] = ["a", "b"]

# One channel, samples x 1, with its name and the setting.
with h5py.File("one_channel.h5", "w") as f:
    d = f.create_dataset("record_01/signals", data=x[:, None])
    d.attrs["channels"] = ["position"]
    d.attrs["sample_rate_hz"] = 2000.0
    d.attrs["frequency_hz"] = 12.5

# A table of named fields, and three dimensions: records x samples x channels.
with h5py.File("fields_and_cube.h5", "w") as f:
    rows = np.zeros(n, dtype=[("t", "f8"), ("n", "i4"), ("tag", "S4"), ("v", "f4")])
    rows["t"], rows["n"], rows["v"] = t, np.arange(n), x
    f["table"] = rows
    cube = f.create_dataset("cube", data=np.arange(2 * 5 * 3, dtype="i4").reshape(2, 5, 3), chunks=(1, 5, 3), compression="gzip")
    cube.attrs["names"] = ["a", "b", "c"]

# The newest layouts, which hdf5-pure refuses; compact storage; extensible along two dimensions.
with h5py.File("latest.h5", "w", libver="latest") as f:
    f.attrs["sample_rate_hz"] = 2000.0
    f.create_dataset("x", data=x)
    f.create_dataset("y", data=y, chunks=(16,), compression="gzip", maxshape=(None,))
    f["x"].attrs["unit"] = "mm/s"
with h5py.File("latest_two_unlimited.h5", "w", libver="latest") as f:
    f.create_dataset("xy", data=np.stack([x, y], axis=1), chunks=(16, 2), maxshape=(None, None), compression="gzip")
# Attributes that the second library reads, and some that it does not.
with h5py.File("latest_attributes.h5", "w", libver="latest") as f:
    f.attrs["rig"] = "A"
    run = f.create_dataset("run", data=np.stack([x, y], axis=1), chunks=(16, 2), maxshape=(None, None))
    run.attrs["sample_rate_hz"] = 2000.0
    run.attrs["units"] = np.array([b"mm/s", b"V"])
    run.attrs["channels"] = ["x", "y"]
    run.attrs["calibration"] = np.array([(1.0, 2)], dtype=[("gain", "f8"), ("bits", "i4")])
with h5py.File("compact.h5", "w") as f:
    plist = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    plist.set_layout(h5py.h5d.COMPACT)
    for name, s in (("x", x), ("y", y)):
        space = h5py.h5s.create_simple((n,))
        h5py.h5d.create(f.id, name.encode(), h5py.h5t.NATIVE_DOUBLE, space, plist).write(
            h5py.h5s.ALL, h5py.h5s.ALL, s
        )

# 10^12 samples of which none is stored.
with h5py.File("claims_too_much.h5", "w") as f:
    f.create_dataset("x", shape=(10**12,), dtype="f8", chunks=(4096,), compression="gzip")
