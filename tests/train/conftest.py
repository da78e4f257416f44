import torch as th

th.set_num_threads(1)  # more threads than idle cores make small networks a hundred times slower
