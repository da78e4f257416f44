from layering import ROOT, sources
from sizes import cpp_functions, oversized, python_functions


def test_every_file_and_function_keeps_to_the_house_sizes() -> None:
    found = []
    for path in sources(".hpp", ".cpp", ".py"):
        found += oversized(str(path.relative_to(ROOT)), path.read_text())
    assert found == []


def test_a_long_cpp_function_is_found() -> None:
    body = "\n".join(f"  x += {k};" for k in range(50))
    text = f"namespace rtg {{\n\nint f(int x,\n      int y) {{\n{body}\n  return x;\n}}\n}}\n"
    assert oversized("core/a.cpp", text) == ["core/a.cpp: 54 lines, at most 40: int f(int x,"]


def test_control_blocks_and_types_are_no_functions() -> None:
    text = "struct A {\n  int f() const {\n    if (x) {\n    }\n    return 1;\n  }\n};\n"
    assert cpp_functions(text) == [("int f() const {", 5)]


def test_a_long_python_function_is_found() -> None:
    text = 'def f():\n    """One.\n\n    Two."""\n' + "    x = 1\n" * 41
    assert python_functions(text) == [("f", 42)]


def test_a_long_header_is_found() -> None:
    assert oversized("core/a.hpp", "\n" * 151) == ["core/a.hpp: 151 lines, at most 150"]
