"""Makes the Parquet files of this folder with polars and pyarrow: python make_parquet.py"""
from datetime import datetime, timedelta

import numpy as np
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq

n = 50
t = np.arange(n) / 2000.0
x = np.sin(2 * np.pi * 12.6 * t)
wide = pl.DataFrame(
    {
        "time [s]": t,
        "x [mm/s]": x,
        "f32": x.astype("f4"),
        "i8": np.arange(n, dtype="i1"),
        "i16": np.arange(n, dtype="i2"),
        "u16": np.arange(n, dtype="u2"),
        "i32": np.arange(n, dtype="i4"),
        "i64": np.arange(n, dtype="i8"),
        "u64": np.arange(n, dtype="u8"),
        "contact": x > 0.5,
        "note": ["fine"] * n,
        "when": [datetime(2024, 5, 1) + timedelta(milliseconds=i) for i in range(n)],
        "gaps": [None if i % 10 == 3 else float(i) for i in range(n)],
    }
)
wide.write_parquet("wide.parquet")
for codec in ("snappy", "gzip", "zstd", "lz4", "uncompressed"):
    wide.select("time [s]", "x [mm/s]").write_parquet(f"wide_{codec}.parquet", compression=codec, row_group_size=20)
rows = [wide.select(pl.lit(f"run{k}").alias("record"), (pl.col("x [mm/s]") * k).alias("x [mm/s]"), pl.col("time [s]")) for k in (1, 2, 10)]
pl.concat(rows).write_parquet("long_by_record.parquet", row_group_size=40)
tidy = [
    pl.DataFrame({"run": [f"run{k}"] * n, "channel": [c] * n, "time": t, "value": x * k * s})
    for k in (1, 2)
    for c, s in (("vx", 1.0), ("vy", -1.0))
]
pl.concat(tidy).sort("run", "time", "channel").write_parquet("long_tidy.parquet")

# as Spark and older programs write points in time, and numbers of two bytes
when = (np.arange(n) * 500_000 + 1_714_521_600_000_000_000).astype("datetime64[ns]")
half = [None if i == 3 else v for i, v in enumerate(x.astype("f2"))]
old = pa.table({"when": pa.array(when), "x [mm/s]": pa.array(half, pa.float16()), "f64": pa.array(x)})
pq.write_table(old, "int96_and_half.parquet", use_deprecated_int96_timestamps=True, row_group_size=20)
