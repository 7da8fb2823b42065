"""Benchmark of sweeps against peers: `python -m benchmarks` from the root of the repository.

`run` is the driver, `parts` lists what is measured, `contestants` who is. The numbers of every part go to
`out/bench/benchmark.json` as they are measured; `benchmark.md` and `work_precision.png` are made from that file;
`--record` puts all three into `benchmarks/results/` as well. `targets` says what is wanted beside what was measured.
"""
