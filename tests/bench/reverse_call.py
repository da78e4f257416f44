"""Prints the CPU time [ms] of rtg.ReverseSimulator.solve, as the program reverse_call in C++ does.

reverse_call.py FILE STATES
"""

import sys
import time

import rtg


def main(task: rtg.Task, states: int) -> None:
    simulator = rtg.ReverseSimulator(task)
    for seed in range(1, states + 1):
        state = task.goal_state(seed)
        begin = time.thread_time()
        simulator.solve(state, range(task.actions))
        print(f"{1e3 * (time.thread_time() - begin):.4f}")


if __name__ == "__main__":
    main(rtg.load_task(sys.argv[1]), int(sys.argv[2]))
