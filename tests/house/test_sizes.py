import pytest
from layering import ROOT, sources
from sizes import cpp_functions, cpp_parameters, oversized, python_functions, python_parameters


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


def test_six_parameters_are_too_many_in_either_language():
    cpp = (
        "namespace rtg {\n\nvoid f(int a, const B& b, C* c,\n       D d = {1, 2}, E e, F f);\n\n}\n"
    )
    assert oversized("core/a.hpp", cpp) == [
        "core/a.hpp: 6 parameters, at most 5: void f(int a, const B& b, C* c,"
    ]
    python = "def f(a, b, /, c, *args, d=1, e=2, g=3, **kwargs):\n    pass\n"
    assert oversized("train/a.py", python) == ["train/a.py: 6 parameters, at most 5: f"]


@pytest.mark.parametrize(
    ("text", "counts"),
    [
        ("f(a, b * c, d < e, g, h > i, j);", []),  # a call
        ("return f(a, b);", []),
        ('f("a, int b", a /* int b */);  // int c', []),
        ("void f();", []),
        ("void f(int);", []),  # a type alone looks like an argument
        ("void f(const A&, B*);", [2]),
        ("A::A(std::map<int, std::vector<B>> a, int b) : a_(a, b), c_{d, e} {", [2]),
        ("f(a, [&](int a, const B& b) { return c(a, b); });", [2]),
        ("void f(std::function<void(int a, B b)> f, std::array<C, 3>&& g);", [2, 2]),
        ("template <class... T>\nvoid f(T&&... t, int x = g(1, 2), bool y = a < b);", [3]),
    ],
)
def test_parameters_of_cpp_are_told_from_arguments(text, counts):
    assert [count for _, count in cpp_parameters(text)] == counts


def test_self_and_cls_are_no_parameters_of_python():
    text = """
class A:
    def f(self, a):
        return lambda b, c: a

    def g(cls, *, a, b): ...
"""
    assert sorted(python_parameters(text)) == [("f", 1), ("g", 2), ("lambda", 2)]
