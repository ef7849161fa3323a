"""Times many strands of a peer side by side, as the scripts beside it time one.

Arguments: the peers' folder, the file to append to, strands, and steps of 1/24 s. The errors are those of one strand:
the strands don't meet.
"""
import csv
import os
import sys
import time

os.environ["OMP_NUM_THREADS"] = "1"
folder, out, strands, steps = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4].split(",")
sys.path.insert(0, folder)
ELEMENTS, GAMMA, FRAMES = 20, 10.0, 24


def best(run):
    """The shortest of runs of a second, in seconds for a strand."""
    times = []
    while len(times) < 2 or (sum(times) < 2.0 and len(times) < 10):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times) / strands


def mujoco_chain(k):
    import mujoco
    from bench_mujoco import chain

    one = chain(ELEMENTS, GAMMA, 1 / 24 / k, "discrete", 0.0)
    head, rest = one.split("<worldbody>")
    body, tail = rest.split("</worldbody>")
    bodies = "".join(body.replace('name="tip"', 'name="tip%d"' % s) for s in range(strands))
    text = head.replace('memory="64M"', 'memory="1G"') + "<worldbody>" + bodies + "</worldbody>" + tail
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)

    def run():
        mujoco.mj_resetData(model, data)
        mujoco.mj_step(model, data, FRAMES * k)

    return "mujoco-" + mujoco.__version__, "chain", "discrete", best(run)


def pypbd_direct(k):
    from bench_pbd import build

    sim, model, stepper, h = build(ELEMENTS, GAMMA, "direct", 1, 1 / 24 / k, strands)

    def run():
        for _ in range(FRAMES * k):
            stepper.step(model)

    return "pypbd-2.2.2", "direct_it1", "PBD-BE", best(run)


with open(out, "a", newline="") as file:
    for measure in {"mujoco": [mujoco_chain], "pypbd": [pypbd_direct]}[sys.argv[5]]:
        for k in map(int, steps):
            peer, model, integrator, seconds = measure(k)
            row = [peer, model, integrator, "many", GAMMA, ELEMENTS, 0, 1 / 24 / k, k, "", seconds, 0]
            csv.writer(file).writerow(row)
            file.flush()
os._exit(0)
