"""Mistakes that nobody has written down: the port to NumPy with one change of a line that it has used. A change is of one of
few kinds (a sign, a number, a name for a like one, two arguments exchanged, a term or a statement left out), or the same
change at all like places of a function. Modules are changed in place, function by function, which takes a millisecond.
"""
import ast
import collections
import contextlib
import copy
import functools
import itertools
import re
import sys
import types

import numpy as np

from . import catalogue

LONGEST = 110  # letters of a piece of code that is told
OPERATORS = {ast.Add: (ast.Sub,), ast.Sub: (ast.Add,), ast.Mult: (ast.Div,), ast.Div: (ast.Mult,), ast.FloorDiv: (ast.Mod,),
             ast.Mod: (ast.FloorDiv,), ast.LShift: (ast.RShift,), ast.RShift: (ast.LShift,), ast.BitAnd: (ast.BitOr,),
             ast.BitOr: (ast.BitAnd, ast.BitXor), ast.BitXor: (ast.BitOr, ast.BitAnd)}
ORDERS = {ast.Lt: (ast.LtE, ast.Gt), ast.LtE: (ast.Lt, ast.GtE), ast.Gt: (ast.GtE, ast.Lt), ast.GtE: (ast.Gt, ast.LtE),
          ast.Eq: (ast.NotEq,), ast.NotEq: (ast.Eq,), ast.Is: (ast.IsNot,), ast.IsNot: (ast.Is,), ast.In: (ast.NotIn,),
          ast.NotIn: (ast.In,)}
LIKE = [{"min", "max"}, {"any", "all"}, {"rint", "floor", "ceil", "trunc"}, {"cos", "sin"}, {"minimum", "maximum"}, {"int64", "int32"}]
AWAY = "np.trunc({0} + np.copysign(0.5, {0}))"  # the nearest whole number, ties away from zero


class Change:
    """One change of the port. text: how it is told; rank: likelier ones have a lower one; line: (where, the statement)
    that is changed; of_input: what an operator is given is another, and no other operator is concerned."""

    line, of_input = None, False

    def __init__(self, text, rank, apply, of_input=False):
        self.text, self.name, self.rank, self.apply, self.of_input = text, text, rank, apply, of_input


# --- functions of a copy of the port ---


@functools.cache
def _tree(file):
    return ast.parse((catalogue.PORT / file).read_text(encoding="utf-8"))


@functools.cache
def definitions(name):
    """Functions and methods of a module: {first line of the code: (names that lead to it, tree)}."""
    found = {}
    for top in _tree(f"{name}.py").body:
        inside = [((top.name, getattr(each, "name", "")), each) for each in top.body] if isinstance(top, ast.ClassDef) else [((getattr(top, "name", ""),), top)]
        for path, tree in ((path, tree) for path, tree in inside if isinstance(tree, ast.FunctionDef)):
            tree.decorator_list = []
            found[tree.lineno] = path, tree
    return found


def words_of(tree):
    """All names in a piece of code."""
    return {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)} | {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}


def functions_of(change):
    """Names of the functions that a change, or a mistake of the catalogue, is in."""
    if isinstance(change, Change):
        return {getattr(change, "where", "").rpartition(".")[2]}
    lines = [(file.removesuffix(".py"), catalogue.line_number(file, line) + 1) for file, line, _ in change.changes]
    return {path[-1] for module, number in lines for path, tree in definitions(module).values() if tree.lineno <= number <= tree.end_lineno}


def _function(module, path):
    found = module
    for word in path:
        found = vars(found)[word] if isinstance(found, type) else getattr(found, word)
    found = found.fget if isinstance(found, property) else getattr(found, "__wrapped__", found)
    return found if isinstance(found, types.FunctionType) else None


@contextlib.contextmanager
def _code_of(function, tree):
    """The function has the code of this tree for a while."""
    whole = compile(ast.Module([tree], []), function.__code__.co_filename, "exec")
    code = next(one for one in whole.co_consts if isinstance(one, types.CodeType))
    before, function.__code__ = function.__code__, code
    try:
        yield
    finally:
        function.__code__ = before


class Used:
    """Which lines of a copy of the port's modules a call uses."""

    def __init__(self, modules, function, *arguments):
        self.modules, self.lines = modules, collections.defaultdict(set)
        files = {module.__file__: name for name, module in modules.items() if name != "broken_port"}

        def follow(frame, event, _):
            name = files.get(frame.f_code.co_filename)
            if name is None or frame.f_globals is not modules[name].__dict__:
                return None
            if event == "line":
                self.lines[name].add(frame.f_lineno)
            return follow

        before = sys.gettrace()
        sys.settrace(follow)
        try:
            function(*arguments)
        finally:
            sys.settrace(before)

    def functions(self):
        """(module's name, path, function, tree, used lines) of each function that was used."""
        for name, lines in self.lines.items():
            for path, tree in definitions(name).values():
                inside = {line for line in lines if tree.body[0].lineno <= line <= tree.end_lineno}
                function = inside and _function(self.modules[name], path)
                if function and not function.__closure__:
                    yield name, path, function, tree, inside


# --- places of a function, and what may stand there ---


class Place:
    """A node, and where it hangs."""

    def __init__(self, parent, field, index, node, above):
        self.parent, self.field, self.index, self.node, self.above = parent, field, index, node, above

    def put(self, node):
        if self.index is None:
            setattr(self.parent, self.field, node)
        else:
            getattr(self.parent, self.field)[self.index] = node


def _places(tree, above=()):
    for field, value in ast.iter_fields(tree):
        for index, node in enumerate(value) if isinstance(value, list) else ((None, value),):
            if isinstance(node, ast.AST) and not isinstance(node, (ast.expr_context, ast.operator, ast.cmpop, ast.boolop, ast.unaryop)):
                yield Place(tree, field, index, node, (*above, tree))
                yield from _places(node, (*above, tree))


def _with(node, **fields):
    """A copy of the top of a node with other fields."""
    return type(node)(**{**{field: getattr(node, field) for field in node._fields}, **fields})


def _number(value):
    return ast.UnaryOp(ast.USub(), ast.Constant(-value)) if value < 0 else ast.Constant(value)


def _of_constant(node):
    value = node.value
    if isinstance(value, bool):
        yield "flag", 1, ast.Constant(not value)
    elif isinstance(value, int):
        for other in dict.fromkeys((value + 1, value - 1, 0, 1, 2 * value, value // 2, -value)):
            if other != value:
                yield f"number {other - value}", 1 if abs(other - value) == 1 else 2, _number(other)
    elif isinstance(value, float):
        for factor in (2.0, 0.5, 0.0, -1.0, 4.0, 0.25):
            yield f"factor {factor}", 1, _number(factor * value)
        for other in (1.0, value * value, value + 1, value - 1):
            if other != value:
                yield f"number {other}", 2, _number(other)


def _exchanged(items):
    for i, j in itertools.combinations(range(len(items)), 2):
        if ast.dump(items[i]) != ast.dump(items[j]) and not any(isinstance(items[k], ast.Starred) for k in (i, j)):
            other = list(items)
            other[i], other[j] = items[j], items[i]
            yield f"{i} {j}", other


def _called(node):
    """The name of what is called."""
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def _of_call(node):
    if _called(node) in ("min", "max") and len(node.args) == 2 and isinstance(node.args[0], ast.Call) and _called(node.args[0]) in ("min", "max"):
        yield "not clamped", 0, node.args[0].args[0]
    if _called(node) == "rint":
        yield "ties away from zero", 1, ast.parse(AWAY.format(ast.unparse(node.args[0])), mode="eval").body
    for which, arguments in _exchanged(node.args):
        yield f"exchanged {which}", 1, _with(node, args=arguments)
    if len(node.args) == 1 and not node.keywords and not isinstance(node.args[0], (ast.Starred, ast.GeneratorExp)):
        yield "not called", 1, node.args[0]
    for k in range(len(node.args) if len(node.args) > 1 else 0):
        yield f"the argument {k}", 2, node.args[k] if not isinstance(node.args[k], ast.Starred) else node.args[k].value


def _of_binary(node):
    for kind in OPERATORS.get(type(node.op), ()):
        yield f"operator {kind.__name__}", 1, _with(node, op=kind())
    yield "left alone", 1, node.left
    yield "right alone", 1, node.right
    if isinstance(node.op, (ast.Sub, ast.Div, ast.FloorDiv, ast.Mod, ast.LShift, ast.RShift)):
        yield "operands exchanged", 1, _with(node, left=node.right, right=node.left)
    if isinstance(node.op, (ast.Mult, ast.Div)):
        for k, side in enumerate((node.left, node.right)):
            yield f"twice {k}", 2, ast.BinOp(node, node.op, side)
    for factor in (2.0, 0.5) if isinstance(node.op, (ast.Mult, ast.Div, ast.Add, ast.Sub)) else ():
        yield f"factor {factor}", 2, ast.BinOp(ast.Constant(factor), ast.Mult(), node)


def _of_compare(node):
    for k, op in enumerate(node.ops):
        for kind in ORDERS.get(type(op), ()):
            yield f"order {k} {kind.__name__}", 0, _with(node, ops=[*node.ops[:k], kind(), *node.ops[k + 1 :]])
    if len(node.ops) == 1:
        yield "turned round", 1, _with(node, left=node.comparators[0], comparators=[node.left])


def _of_bool(node):
    other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
    yield "and for or", 1, _with(node, op=other)
    for k in range(len(node.values)):
        rest = [value for j, value in enumerate(node.values) if j != k]
        yield f"without {k}", 0, rest[0] if len(rest) == 1 else _with(node, values=rest)


def _of_name(node):
    """Numbers near one that has a name; values of it."""
    for text, made in (("+ 1", ast.BinOp(node, ast.Add(), ast.Constant(1))), ("- 1", ast.BinOp(node, ast.Sub(), ast.Constant(1))),
                       ("0", ast.BinOp(ast.Constant(0), ast.Mult(), node)), ("negative", ast.UnaryOp(ast.USub(), node)),
                       ("twice", ast.BinOp(ast.Constant(2), ast.Mult(), node)), ("half", ast.BinOp(ast.Constant(0.5), ast.Mult(), node)),
                       ("half of a whole", ast.BinOp(node, ast.FloorDiv(), ast.Constant(2)))):
        yield f"name {text}", 3, made


def _of_sequence(node):
    if not isinstance(node.ctx, ast.Load):
        return
    for which, elements in _exchanged(node.elts):
        yield f"exchanged {which}", 1, _with(node, elts=elements)
    for k in range(len(node.elts) if len(node.elts) > 2 else 0):
        yield f"all but {k}", 3, _with(node, elts=[each for j, each in enumerate(node.elts) if j != k])


def _of_slice(node):
    """A part of a table that begins one later or earlier, of the same length."""
    bounds = [node.lower, node.upper]
    if node.step is None and all(bound is None or isinstance(bound, ast.Constant) for bound in bounds) and (node.lower or node.upper):
        for off in (1, -1, 2):
            moved = [bound and ast.Constant(bound.value + off) for bound in bounds]
            if off > 0 and node.lower is None:
                moved[0] = ast.Constant(off)
            yield f"moved by {off}", 2, ast.Slice(*moved)


def _of_branch(node):
    yield "always", 0, _with(node, test=ast.Constant(True))
    yield "never", 0, _with(node, test=ast.Constant(False))
    yield "not", 0, _with(node, test=ast.UnaryOp(ast.Not(), node.test))


def _of_statement(node):
    if isinstance(node, (ast.Assign, ast.AugAssign, ast.Expr, ast.Return, ast.Continue, ast.For)):
        yield "left out", 0, ast.Pass()
    if isinstance(node, (ast.AugAssign, ast.Expr, ast.Assign)):
        yield "twice", 1, ast.If(ast.Constant(True), [node, node], [])
    if isinstance(node, ast.AugAssign):
        for kind in OPERATORS.get(type(node.op), ()):
            yield f"operator {kind.__name__}", 0, _with(node, op=kind())
        yield "set", 0, ast.Assign([node.target], node.value)


OF = {ast.Constant: _of_constant, ast.Call: _of_call, ast.BinOp: _of_binary, ast.Compare: _of_compare, ast.BoolOp: _of_bool,
      ast.Slice: _of_slice, ast.Tuple: _of_sequence, ast.List: _of_sequence, ast.IfExp: _of_branch, ast.If: _of_branch}


def _of_like(node, likes, calls):
    """Another name where one of the same sort stands. likes: {attribute or name: others that may stand there}."""
    word = node.attr if isinstance(node, ast.Attribute) else node.id
    for other in likes.get(word, ()):
        yield f"{word} is {other}", 1 if calls else 2, _with(node, **{"attr" if isinstance(node, ast.Attribute) else "id": other})


def _variants(place, likes):
    """(kind, rank, what may stand there)."""
    node = place.node
    if isinstance(node, ast.stmt):
        yield from _of_statement(node)
    if type(node) in OF:
        yield from OF[type(node)](node)
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        for other in likes.get(node.value, ()):
            yield f"{node.value} is {other}", 2, ast.Constant(other)
    if isinstance(node, (ast.Name, ast.Attribute)) and isinstance(node.ctx, ast.Load):
        yield from _of_like(node, likes, isinstance(place.parent, ast.Call) and place.field == "func")
        if not (isinstance(place.parent, ast.Call) and place.field == "func") and not (isinstance(place.parent, ast.Attribute)):
            yield from _of_name(node)
    if isinstance(node, (ast.Subscript, ast.BinOp, ast.Call)) and isinstance(getattr(node, "ctx", ast.Load()), ast.Load):
        yield from _of_stems(node, likes)
        for word in likes.get("", ()):
            yield f"is {word}", 4, ast.Name(word, ast.Load())
    if isinstance(node, ast.UnaryOp):
        yield "without", 1, node.operand
    if isinstance(node, ast.expr) and not isinstance(node, (ast.Constant, ast.UnaryOp, ast.Name, ast.Attribute)) and isinstance(place.parent, (ast.Call, ast.Return, ast.BinOp)):
        yield "negative", 3, ast.UnaryOp(ast.USub(), node)


class _Renamed(ast.NodeTransformer):
    def __init__(self, names):
        self.names = names

    def visit_Name(self, node):  # pylint: disable=invalid-name
        return ast.Name(self.names.get(node.id, node.id), node.ctx)


def _stem(word):
    return word.rstrip("0123456789")


def _of_stems(node, likes):
    """Names that differ in a number are replaced together: vector0 and vector1 for unit0 and unit1."""
    numbered = sorted({word for word in words_of(node) if word in likes.get("", ()) and word != _stem(word)})
    for stem in sorted({_stem(word) for word in numbered}):
        mine = [word for word in numbered if _stem(word) == stem]
        for other in sorted({_stem(word) for word in likes[""] if word != _stem(word)} - {stem}):
            names = {word: other + word[len(stem):] for word in mine}
            if len(mine) > 1 and set(names.values()) <= set(likes[""]):
                yield f"{stem} is {other}", 2, _Renamed(names).visit(copy.deepcopy(node))


def _of_arguments(tree):
    """Two arguments of a function exchanged, in the whole of it."""
    words = [each.arg for each in tree.args.args if each.arg not in ("self", "model")]
    for first, second in itertools.combinations(words, 2):
        begin = ast.parse(f"{first}, {second} = {second}, {first}").body[0]
        yield f"{first} and {second} exchanged", [*tree.body[:1], begin, *tree.body[1:]] if ast.get_docstring(tree) else [begin, *tree.body]


def _locals_of(tree):
    """Names of a function's own values, each with all others."""
    names = {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)} - {"self"}
    names |= {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    return {name: sorted(names - {name}) for name in names}


def _likes(tree, module, sorts):
    """Which names may stand for which: a function's own values, a module's numbers, functions of one sort, and `sorts`."""
    own = _locals_of(tree)
    likes = {**own, **{name: others for name, others in sorts.items()}, "": sorted(own)}
    numbers = sorted(name for name, value in vars(module).items() if name.isupper() and isinstance(value, int))
    likes.update({name: [other for other in numbers if other != name] for name in numbers})
    same = collections.defaultdict(set)
    for name, value in vars(module).items():
        if isinstance(value, types.FunctionType) and value.__module__ == module.__name__:
            same[value.__code__.co_varnames[: value.__code__.co_argcount]].add(name)
    for group in (*same.values(), *LIKE):
        likes.update({name: sorted(group - {name}) for name in group})
    return likes


# --- names that may stand for each other ---


def sorts_of(*things):
    """Attributes of one sort: {name: others that may stand there}, from what they are now."""
    groups = {}
    for thing in things:
        for name, value in vars(thing).items():
            kind = (value.shape, value.dtype.kind) if isinstance(value, np.ndarray) else type(value).__name__
            groups.setdefault((type(thing), kind), []).append(name)
    return {name: [other for other in names if other != name] for names in groups.values() for name in names if len(names) > 1}


def likes_of(tables):
    """The same of tables with names."""
    groups = collections.defaultdict(list)
    for name, value in tables.items():
        groups[value.shape, value.dtype.kind].append(name)
    return {name: [other for other in names if other != name] for names in groups.values() for name in names if len(names) > 1}


# --- the sentence ---


def _shown(place, node):
    """The piece of code around a place, before and after: the smallest that says enough."""
    around, top = place.node, place
    chain = list(place.above)
    while True:
        if (len(ast.unparse(around)) >= 16 or isinstance(around, ast.stmt)) and not isinstance(around, (ast.Name, ast.Constant)):
            break
        if not chain or isinstance(chain[-1], (ast.FunctionDef,)):
            break
        around = chain.pop()
        if not isinstance(around, (ast.expr, ast.stmt)):
            continue
    if isinstance(around, (ast.If, ast.For, ast.While, ast.With)) and around is not place.node:
        around = place.node
    before = ast.unparse(around).split("\n")[0]
    if around is place.node:
        after = ast.unparse(ast.fix_missing_locations(node)).split("\n")[0]
    else:
        top.put(node)
        try:
            after = ast.unparse(ast.fix_missing_locations(around)).split("\n")[0]
        finally:
            top.put(place.node)
    return _cut(before), _cut(after)


def _cut(text):
    return text if len(text) <= LONGEST else text[:LONGEST] + " ..."


def _text(where, edits, kind):
    before, after = _shown(*edits[0])
    also = f", and the same at {len(edits) - 1} more like {'place' if len(edits) == 2 else 'places'}" if len(edits) > 1 else ""
    if kind == "left out" or after == "pass":
        return f"without `{before}`{also} ({where})"
    if kind == "twice" and after.startswith("if True"):
        return f"`{before}` twice{also} ({where})"
    return f"`{after}` for `{before}`{also} ({where})"


class _Edit(Change):
    def __init__(self, where, function, tree, edits, kind, rank):  # pylint: disable=super-init-not-called,too-many-arguments
        self.where, self.function, self.tree, self.edits, self.kind, self.rank = where, function, tree, edits, kind, rank

    @property
    def text(self):
        return _text(self.where, self.edits, self.kind)

    name = text

    @property
    def line(self):
        place = self.edits[0][0]
        around = [node for node in (*place.above, place.node) if isinstance(node, ast.stmt) and not isinstance(node, ast.FunctionDef)]
        return self.where, _cut(ast.unparse(around[-1]).split("\n")[0]) if around else ""

    @contextlib.contextmanager
    def apply(self):
        for place, node in self.edits:
            ast.copy_location(node, place.node)
            ast.fix_missing_locations(node)
            place.put(node)
        try:
            with _code_of(self.function, self.tree):
                yield
        finally:
            for place, _ in reversed(self.edits):
                place.put(place.node)


def _shape(node):
    """What a node is like, whatever its names and numbers are."""
    return " ".join(type(each).__name__ for each in ast.walk(node) if not isinstance(each, ast.expr_context))


def _keys(place):
    """What places are alike by: what stands there, whatever its names are; or the same but for numbers and sides in names; or
    the same piece of code."""
    text = ast.unparse(place.node)
    yield _shape(place.node)
    yield re.sub(r"\d+\b|before|after|first|second|next|prev", "", text)


class _Body(Change):
    """A function with other statements."""

    def __init__(self, where, function, tree, body, text, rank):  # pylint: disable=too-many-arguments
        super().__init__(f"{text} ({where})", rank, self.with_body)
        self.where, self.function, self.tree, self.body = where, function, tree, body

    @contextlib.contextmanager
    def with_body(self):
        other = ast.fix_missing_locations(ast.copy_location(_with(self.tree, body=self.body), self.tree))
        with _code_of(self.function, other):
            yield


def _moved(statements, far=3):
    """(text, statements) of one that comes so many places later or earlier at most."""
    for k, statement in enumerate(statements):
        for to in range(max(0, k - far), min(len(statements), k + far + 1)):
            if to not in (k, k - 1) and not isinstance(statement, ast.Return):
                rest = statements[:k] + statements[k + 1 :]
                before = statements[to] if to < k else statements[to]
                said = "before" if to < k else "after"
                yield f"`{_line(statement)}` {said} `{_line(before)}`", rest[:to] + [statement] + rest[to:]


def _line(node):
    return _cut(ast.unparse(node).split("\n")[0])


def of_function(used, module, sorts):
    """All changes of one function."""
    name, path, function, tree, lines = used
    yield from _of_places(used, module, sorts)
    for text, body in itertools.chain(_of_arguments(tree), _moved(tree.body, 12 if name == "step" else 3)):
        yield _Body(".".join((name, *path)), function, tree, body, text, 1 if name == "step" else 2)


def _of_places(used, module, sorts):
    name, path, function, tree, lines = used
    where, likes, alike = f"{'.'.join((name, *path))}", _likes(tree, module, sorts), collections.defaultdict(list)
    for place in _places(tree):
        node = place.node
        if getattr(node, "lineno", None) is None or not lines.intersection(range(node.lineno, node.end_lineno + 1)):
            continue
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            continue
        for kind, rank, other in _variants(place, likes):
            yield _Edit(where, function, tree, [(place, other)], kind, rank)
            for k, key in enumerate(_keys(place) if rank < 4 else ()):
                alike[kind, rank, k, key].append((place, other))
    seen = set()
    for (kind, rank, _, _), edits in alike.items():
        nested = any(place.node in other.above for place, _ in edits for other, _ in edits)
        same = kind, tuple(id(place.node) for place, _ in edits)
        if len(edits) > 1 and not nested and same not in seen:
            seen.add(same)
            yield _Edit(where, function, tree, edits, kind, rank + 1)


def of_call(modules, sorts, function, kinds=of_function):
    """All changes of what a call uses, likelier ones first; the call must not fail."""
    used = Used(modules, function)
    every = [change for each in used.functions() for change in kinds(each, modules[each[0]], sorts)]
    return sorted(every, key=lambda change: change.rank)


# --- the same numbers, rounded otherwise ---

LIBRARY = {"log": "np.log({0})", "exp": "np.exp({0})", "erf": "np.vectorize(math.erf)({0})",
           "circle_turns": "(np.cos(2 * np.pi * ({0})), np.sin(2 * np.pi * ({0})))", "circle_degrees": "(np.cos(np.pi / 180 * ({0})), np.sin(np.pi / 180 * ({0})))"}
ROUNDED = ("rint", "to_lattice")


def _is(node, *kinds):
    return isinstance(node, ast.BinOp) and isinstance(node.op, kinds)


def _other_roundings(node):
    """(kind, rank, what gives the same but for rounding)."""
    if isinstance(node, ast.BinOp):
        for kinds in ((ast.Add, ast.Sub), (ast.Mult,)):
            if isinstance(node.op, kinds) and _is(node.left, kinds[0]):
                yield "order of a sum", 0, ast.BinOp(node.left.left, kinds[0](), ast.BinOp(node.left.right, node.op, node.right))
                yield "order of a sum, the other", 1, ast.BinOp(node.left.right, kinds[0](), ast.BinOp(node.left.left, node.op, node.right))
            if isinstance(node.op, kinds[0]) and _is(node.right, *kinds):
                yield "order of a sum", 0, ast.BinOp(ast.BinOp(node.left, node.op, node.right.left), node.right.op, node.right.right)
        if _is(node, ast.Div):
            yield "times the inverse", 0, ast.BinOp(ast.BinOp(ast.Constant(1.0), ast.Div(), node.right), ast.Mult(), node.left)
        for one, other in ((node.left, node.right), (node.right, node.left)) if _is(node, ast.Mult) else ():
            if _is(one, ast.Div):
                yield "one division", 0, ast.BinOp(ast.BinOp(one.left, ast.Mult(), other), ast.Div(), one.right)
            if _is(one, ast.Add, ast.Sub):
                yield "term by term", 1, ast.BinOp(ast.BinOp(one.left, ast.Mult(), other), one.op, ast.BinOp(one.right, ast.Mult(), other))
    if isinstance(node, ast.Call) and _called(node) in LIBRARY and len(node.args) == 1:
        yield "of the library", 0, ast.parse(LIBRARY[_called(node)].format(ast.unparse(node.args[0])), mode="eval").body
    if isinstance(node, ast.Call) and _called(node) in ROUNDED:
        inner = node.args[0]
        if _is(inner, ast.Add, ast.Sub):
            yield "rounded one by one", 0, ast.BinOp(_with(node, args=[inner.left]), inner.op, _with(node, args=[inner.right]))
        if _is(inner, ast.Mult):
            yield "rounded before the product", 0, ast.BinOp(inner.left, ast.Mult(), _with(node, args=[inner.right]))


def of_rounding(used, module, sorts):
    """Changes of one function that change last bits alone, or what is cut or rounded to a whole number."""
    name, path, function, tree, lines = used
    for place in _places(tree):
        node = place.node
        if getattr(node, "lineno", None) is None or not lines.intersection(range(node.lineno, node.end_lineno + 1)) or not isinstance(node, ast.expr):
            continue
        for kind, rank, other in itertools.chain(_other_roundings(node), _of_call(node) if isinstance(node, ast.Call) else (),
                                                 _of_like(node, _likes(tree, module, {}), True) if isinstance(node, ast.Attribute) and node.attr in ("rint", "floor", "ceil", "trunc") else ()):
            yield _Edit(".".join((name, *path)), function, tree, [(place, other)], kind, rank)


# --- statements of a step elsewhere ---

ANYWHERE = {"self", "model", "step", "solvent", "fiber", "flow", "events", "sweep", "media", "dumbbells", "np"}


def of_elsewhere(used):
    """A statement of one method, which needs no value of its own, stands in another method."""
    methods = [(path, function, tree) for name, path, function, tree, _ in used if name == "step" and len(path) == 2 and path[1][0] != "_"]
    begin = ast.parse("model, step = self.model, self.finished + 1").body
    for path, function, tree in methods:
        for k, statement in enumerate(tree.body):
            if isinstance(statement, (ast.Return, ast.Assign)) and not ast.unparse(statement).startswith("self.") or not {
                    node.id for node in ast.walk(statement) if isinstance(node, ast.Name)} <= ANYWHERE or "return" in ast.unparse(statement):
                continue
            without = tree.body[:k] + tree.body[k + 1 :] or [ast.Pass()]
            for other, its, where in methods:
                for to in range(len(where.body) + 1) if other != path else ():
                    if to and isinstance(where.body[to - 1], ast.Return) or any(isinstance(node, (ast.Yield, ast.YieldFrom)) for node in ast.walk(where)):
                        continue
                    edits = [(function, without, tree), (its, where.body[:to] + begin + [statement] + where.body[to:], where)]
                    at = f"before `{_line(where.body[to])}`" if to < len(where.body) else "at the end"
                    yield Change(f"`{_line(statement)}` not in {'.'.join(path)}, but in {'.'.join(other)}, {at}", 2, functools.partial(_bodies, edits))


@contextlib.contextmanager
def _bodies(edits):
    with _all([(function, ast.fix_missing_locations(ast.copy_location(_with(tree, body=body), tree))) for function, body, tree in edits]):
        yield


# --- values that are read as others ---


def others(value, given, before):
    """(text, another value) for one argument. before: what it was the last time."""
    if isinstance(value, bool):
        yield str(not value), not value
    elif isinstance(value, (int, float, np.number)):
        for text, other in (("1 more", value + 1), ("1 less", value - 1), ("0", 0 * value), ("twice its value", 2 * value),
                            ("half its value", 0.5 * value), ("minus its value", -value), ("1", 1 + 0 * value), ("4 times its value", 4 * value),
                            ("a quarter of its value", 0.25 * value), ("its value in single precision", float(np.float32(value)))):
            yield text, other
    elif isinstance(value, np.ndarray):
        yield "zeros", np.zeros_like(value)
        yield "ones", np.ones_like(value)
        yield "its negative", ~value if value.dtype == bool else -value
        for other in given:
            if isinstance(other, np.ndarray) and other is not value and (other.shape, other.dtype) == (value.shape, value.dtype):
                yield "what another argument is", other
    if before is not None and type(before) is type(value) and getattr(before, "shape", None) == getattr(value, "shape", None) and before is not value:
        yield "what it was the last time", before


def of_values(values, owner):
    """(text, {name: another value}) for numbers and tables that have names: one of them is another. owner: whose they are."""
    for name, value in values.items():
        like = [other for other, table in values.items() if other != name and getattr(value, "ndim", 0) and getattr(table, "ndim", 0)
                and (table.shape, table.dtype) == (value.shape, value.dtype)]
        what = f"{name.replace('_', ' ')} of {owner}"
        for text, other in others(value, (), None):
            yield f"{what} is {text}", {name: other}
        longer = [other for other, table in values.items() if getattr(value, "ndim", 0) == 2 == getattr(table, "ndim", 0) and len(table) > len(value)
                  and (table.shape[1], table.dtype) == (value.shape[1], value.dtype)]
        for other in (*like, *longer):
            yield f"{what} is {other.replace('_', ' ')}", {name: values[other][: len(value)]}
        for other in like:
            if other > name:
                yield f"{what} and {other.replace('_', ' ')} are exchanged", {name: values[other], other: value}
        if getattr(value, "ndim", 0) and value.dtype.kind in "fi" and value.size:
            yield from ((f"{what}: {text}", {name: made}) for text, made in _of_table(value))


class Spy:
    """A model that knows which of its values are read."""

    def __init__(self, model):
        self.__dict__.update(model=model, read=set())

    def __getattr__(self, name):
        self.read.add(name)
        made = vars(type(self.model)).get(name)
        return made.fget(self) if isinstance(made, property) else getattr(self.model, name)


def of_readers(model, tables):
    """(text, {name: another value}) for values of the model that stand in a table: other columns of it are read."""
    for name, value in vars(model).items():
        for table, rows in tables.items():
            if not isinstance(value, (int, float, np.ndarray)) or isinstance(value, bool):
                continue
            wide = np.shape(value)[-1] if np.ndim(value) and np.shape(value)[-1] == 3 and (np.ndim(value) == 2 or len(rows) == 1) else 1
            columns = [rows[:, k : k + wide] for k in range(rows.shape[1] - wide + 1)]
            for k, column in enumerate(columns):
                made = column[0, 0] if not np.ndim(value) else column.reshape(np.shape(value)) if column.size == np.size(value) else None
                if made is not None and np.asarray(made).dtype == np.asarray(value).dtype and not np.array_equal(made, value):
                    which = f"column {k + 1}" if wide == 1 else f"columns {k + 1} to {k + wide}"
                    yield f"{name.replace('_', ' ')} of the model is read from {which} of {table}", {name: type(value)(made) if not np.ndim(value) else made}


def _of_table(value):
    """(text, what a table of numbers may be read as)."""
    if value.dtype.kind == "f":
        yield "in single precision", value.astype(np.float32).astype(float)
        yield "squared", value * value
        yield "twice its value", 2 * value
        yield "half its value", 0.5 * value
        with np.errstate(all="ignore"):
            yield "its inverse", 1 / value
        yield "its root", np.sqrt(np.abs(value))
        yield "its size", np.abs(value)
    yield "that of the first row for all", np.broadcast_to(value[:1], value.shape).copy()
    yield "that of the next row", np.roll(value, -1, 0)
    yield "that of the row before", np.roll(value, 1, 0)
    if value.ndim == 2 and 1 < value.shape[1] <= 8:
        for i, j in itertools.combinations(range(value.shape[1]), 2):
            order = [{i: j, j: i}.get(k, k) for k in range(value.shape[1])]
            yield f"columns {i + 1} and {j + 1} are exchanged", value[:, order]
            yield f"column {i + 1} has what column {j + 1} has", value[:, [j if k == i else k for k in range(value.shape[1])]]
            yield f"column {j + 1} has what column {i + 1} has", value[:, [i if k == j else k for k in range(value.shape[1])]]
        for k in range(value.shape[1]):
            for text, factor in (("0", 0), ("negative", -1), ("twice its value", 2), ("half its value", 0.5)):
                if value.dtype.kind == "f" or factor != 0.5:
                    made = value.copy()
                    made[:, k] = made[:, k] * factor
                    yield f"column {k + 1} is {text}", made


# --- the catalogue, in place ---


@contextlib.contextmanager
def _all(edits):
    with contextlib.ExitStack() as stack:
        for function, tree in edits:
            stack.enter_context(_code_of(function, tree))
        yield


def _changed(lines, tree, changes):
    """A function's tree with lines changed."""
    own = lines[tree.lineno - 1 : tree.end_lineno]
    for number, line, replacement in changes:
        k = number - tree.lineno + 1
        own[k] = own[k][: -len(line)] + replacement
    indent = len(own[0]) - len(own[0].lstrip())
    made = ast.parse("\n".join(line[indent:] for line in own)).body[0]
    return made


def of_catalogue(mistakes, used):
    """Mistakes of the catalogue that are in functions which were used."""
    functions = [each for each in used.functions()]
    for mistake in mistakes:
        edits = []
        for name, _, function, tree, _ in functions:
            changes = [(catalogue.line_number(file, line), line, replacement) for file, line, replacement in mistake.changes if file == f"{name}.py"]
            changes = [change for change in changes if tree.lineno <= change[0] + 1 <= tree.end_lineno]
            if changes:
                edits.append((function, tree, name, changes))
        if edits:
            yield Change(mistake.text, 0, functools.partial(_catalogued, edits))


@contextlib.contextmanager
def _catalogued(edits):
    trees = [(function, _changed((catalogue.PORT / f"{name}.py").read_text(encoding="utf-8").splitlines(), tree, changes))
             for function, tree, name, changes in edits]
    with _all(trees):
        yield
