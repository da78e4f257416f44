"""The numbered examples of the package, and arguments with which the long ones take little."""

import pkgutil

import rtg.examples

ALL = (module.name for module in pkgutil.iter_modules(rtg.examples.__path__))
NAMES = sorted(name for name in ALL if name[0].isdigit())
SMALL = {
    "08_own_learner": {"transitions": 1000, "steps": 20},
    "09_train": {"transitions": 500, "interactions": 80},
    "10_own_data": {"transitions": 300, "interactions": 80},
    "11_own_engine": {"transitions": 300},
}
