"""The list of the runs of a comparison."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from rtg.compare.cells import Cell, Grid, read_grid, update_grid
from rtg.errors import UserError

ONE = Cell("gathering", "ddqn_rtg", (), 1)
TWO = Cell("sorting", "ddqn_rtg", ("train.batch=8",), 2)


def test_a_grid_reads_back_to_itself(tmp_path):
    grid = Grid({ONE: "./run.sh reproduce", TWO: "again"}, {TWO.name: "rtg: no memory"})
    grid.write(tmp_path)
    assert read_grid(tmp_path) == grid
    assert read_grid(tmp_path / "elsewhere") == Grid({}, {})


def test_a_command_is_forgotten_once_others_ask_for_all_that_it_asked_for():
    grid = Grid({}, {})
    grid.add("one", [ONE])
    grid.add("two", [TWO])
    assert grid.commands == ["one", "two"]
    grid.add("both", [TWO, ONE])
    assert grid.commands == ["both"] and list(grid.commands_by_cell) == [ONE, TWO]
    grid.add("two", [TWO])
    assert grid.commands == ["both", "two"]


def test_commands_that_add_cells_at_the_same_time_lose_none(tmp_path):
    def add(command):
        cell = Cell(command, "ddqn_rtg", (), 1)
        update_grid(tmp_path, lambda grid: grid.add(command, [cell]))

    commands = [f"command {number}" for number in range(40)]
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(add, commands))
    assert sorted(read_grid(tmp_path).commands) == sorted(commands)


@pytest.mark.parametrize("text", ["[]", "{", '{"cells": [{"task": "x"}]}', '{"cells": 3}'])
def test_a_damaged_file_is_named(tmp_path, text):
    (tmp_path / "grid.json").write_text(text)
    with pytest.raises(UserError, match=r"grid\.json: is damaged; legal: the file as "):
        read_grid(tmp_path)
