"""Makes the files of this folder with the field's own writers and reads each back with the field's own reader.

python make_goldens.py; needs numpy 2.4, scipy 1.17, h5py 3.16, npTDMS 1.13, pyuff 2.5, lvm_read 1.26, mat73 0.65, polars 2.1.
The values that it asserts are quoted in ../../goldens.rs.
"""
import os
import wave

import h5py
import lvm_read
import mat73
import numpy as np
import polars as pl
import pyuff
import scipy.io
import scipy.io.wavfile
from nptdms import ChannelObject, GroupObject, RootObject, TdmsFile, TdmsWriter

x = np.array([0.5, -1.25, 3.0, 1e-3, -2.5, 7.75])  # mm
count = np.array([1, -2, 300, -4000, 32767, -32768], dtype=np.int16)
t = np.arange(6) / 2000.0
SAME_TIME = "2024-05-01T12:00:00"

# TDMS: two segments, of which the second has the last two samples.
with TdmsWriter("small.tdms") as writer:
    root = RootObject({"operator": "Novák"})
    group = GroupObject("run 1", {"clearance_m": 0.001})

    def part(s):
        properties = {"unit_string": "mm", "wf_increment": 0.0005, "wf_start_time": np.datetime64(SAME_TIME)}
        return [
            ChannelObject("run 1", "x", x[s], properties),
            ChannelObject("run 1", "count", count[s]),
            ChannelObject("run 1", "label", [f"no {i}" for i in range(6)][s]),
        ]

    writer.write_segment([root, group, *part(slice(0, 4))])
    writer.write_segment(part(slice(4, 6)))
read = TdmsFile.read("small.tdms")["run 1"]
assert np.array_equal(read["x"][:], x) and np.array_equal(read["count"][:], count) and read["label"][5] == "no 5"

# UFF 58: real over even time and complex over frequency, as text and binary.
force = np.array([1 + 2j, -0.5 + 0.25j, 3 - 4j])
for name, binary in (("small_text.uff", 0), ("small_binary.uff", 1)):
    if os.path.exists(name):
        os.remove(name)
    file = pyuff.UFF(name)
    common = {"type": 58, "binary": binary, "id1": "run 1", "rsp_node": 3, "rsp_dir": 3, "ref_node": 1, "ref_dir": 3, "load_case_id": 0}
    common |= {f"{axis}_spec_data_type": 0 for axis in ("orddenom", "z_axis", "ordinate")} | {"orddenom_axis_units_lab": "NONE"}
    time = {"func_type": 1, "ord_data_type": 4, "abscissa_spacing": 1, "abscissa_inc": 0.0005, "abscissa_min": 0.0}
    axis = {"abscissa_spec_data_type": 17, "abscissa_axis_units_lab": "s", "ordinate_axis_units_lab": "mm"}
    frf = {"func_type": 4, "ord_data_type": 6, "abscissa_spacing": 1, "abscissa_inc": 0.5, "abscissa_min": 0.0}
    hertz = {"abscissa_spec_data_type": 18, "abscissa_axis_units_lab": "Hz", "ordinate_axis_units_lab": "N"}
    file.write_sets({**common, **time, **axis, "data": x, "x": t}, "add")
    file.write_sets({**common, **frf, **hertz, "data": force, "x": np.arange(3) * 0.5}, "add")
    first, second = pyuff.UFF(name).read_sets()
    assert np.array_equal(first["data"], x) and np.array_equal(second["data"], force), name

# LVM: no free library writes it; this is LabVIEW's documented form, read back by lvm_read.
header = ["LabVIEW Measurement\t", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab", "Decimal_Separator\t,"]
header += ["Multi_Headings\tNo", "X_Columns\tOne", "Time_Pref\tRelative", "Date\t2024/05/01", "Time\t12:00:00,5"]
header += ["***End_of_Header***\t", "\t"]
segment = ["Channels\t2\t\t", "Samples\t6\t6\t", "Date\t2024/05/01\t2024/05/01\t", "Time\t12:00:00,5\t12:00:00,5\t"]
segment += ["Y_Unit_Label\tmm\tVolts\t", "X_Dimension\tTime\tTime\t", "X0\t0,0\t0,0\t", "Delta_X\t0,0005\t0,0005\t"]
segment += ["***End_of_Header***\t\t\t", "X_Value\tx\tcount\tComment"]
rows = ["\t".join(repr(float(v)).replace(".", ",") for v in row) for row in zip(t, x, count)]
with open("small.lvm", "w", newline="\r\n") as f:
    f.write("\n".join(header + segment + rows) + "\n")
assert np.array_equal(lvm_read.read("small.lvm", read_from_pickle=False, dump_file=False)[0]["data"][:, 1], x)

# WAV: 16 and 24 bits of PCM by Python's own module, 32 bits of floating point by scipy.
scipy.io.wavfile.write("small_16.wav", 2000, np.stack([count, -(count // 2)], axis=1))
scipy.io.wavfile.write("small_float.wav", 2000, x.astype(np.float32))
with wave.open("small_24.wav", "wb") as f:
    f.setnchannels(1), f.setsampwidth(3), f.setframerate(2000)
    f.writeframes(b"".join(int(v).to_bytes(3, "little", signed=True) for v in (1, -1, 2**23 - 1, -(2**23))))
assert scipy.io.wavfile.read("small_16.wav")[1][4].tolist() == [32767, -16383]
assert scipy.io.wavfile.read("small_24.wav")[1].tolist() == [256, -256, 2147483392, -2147483648]

# MATLAB: level 4, 5 (v6), 5 compressed (v7); the struct array is a record an element.
plain = {"fs": 2000.0, "x": x.reshape(-1, 1), "x_unit": "mm", "pair": np.stack([x, 2 * x], axis=1)}
runs = np.zeros((1, 2), dtype=[("v", object), ("clearance_m", object)])
for k in range(2):
    runs[0, k] = ((k + 1) * x.reshape(-1, 1), 0.001 * (k + 1))
rich = {**plain, "z": np.array([[1 + 2j], [3 - 4j]]), "count": count.reshape(-1, 1), "runs": runs}
scipy.io.savemat("small_v4.mat", plain, format="4")
scipy.io.savemat("small_v6.mat", rich, format="5")
scipy.io.savemat("small_v7.mat", rich, format="5", do_compression=True)
for name in ("small_v4.mat", "small_v6.mat", "small_v7.mat"):
    assert np.array_equal(scipy.io.loadmat(name)["pair"][:, 1], 2 * x), name

# MATLAB 7.3: HDF5 behind a block of 512 bytes, with MATLAB's attributes; read back by mat73.
with h5py.File("small_v73.mat", "w", userblock_size=512) as f:

    def variable(group, name, data, kind):
        d = group.create_dataset(name, data=data)
        d.attrs["MATLAB_class"] = np.bytes_(kind)
        return d

    variable(f, "fs", np.array([[2000.0]]), "double")
    variable(f, "pair", np.stack([x, 2 * x]), "double")  # reversed dimensions: 6 x 2 in MATLAB
    variable(f, "count", count.reshape(1, -1), "int16")
    variable(f, "x_unit", np.array([[ord(c)] for c in "mm"], dtype=np.uint16), "char").attrs["MATLAB_int_decode"] = np.int32(2)
    rig = f.create_group("rig")
    rig.attrs["MATLAB_class"] = np.bytes_("struct")
    variable(rig, "z", np.array([[(1.0, 2.0), (3.0, -4.0)]], dtype=[("real", "f8"), ("imag", "f8")]), "double")
head = b"MATLAB 7.3 MAT-file".ljust(116) + bytes(8) + b"\x00\x02IM"
with open("small_v73.mat", "r+b") as f:
    f.write(head)
assert np.array_equal(mat73.loadmat("small_v73.mat")["pair"][:, 1], 2 * x)

# Text tables: as polars writes them, and with decimal commas.
frame = pl.DataFrame({"time [s]": t, "x [mm]": x, "note": ["a", None, 'say "hi"', "b;c", "d", "e"]})
frame.write_csv("comma.csv")
frame.select("time [s]", "x [mm]").write_csv("decimal_comma.csv", separator=";", decimal_comma=True)
assert pl.read_csv("comma.csv")["x [mm]"].to_list() == x.tolist()
