"""Reads a C++ source without the compiler: its includes, calls, exceptions and variables, and the names that it uses.

The parser is tree-sitter, which needs no headers and reads sources that do not compile; this module alone imports it.
Each file is read once, for all profiles. `cfepy.extra.convert.node_check.program` interprets the places, because that
depends on the other files of the program.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from cfepy.extra.convert.node_check.findings import GraphName, SourcePlace
from cfepy.extra.convert.node_check.source_file import Include, Main, Met, SourceFile
from cfepy.status import UsageError

if TYPE_CHECKING:
    from tree_sitter import Node, Parser, Tree

HINT = "the check requires tree-sitter: pip install 'cfepy[convert]'"
CALLS: dict[str, str] = {
    **dict.fromkeys(("exit", "_exit", "_Exit", "quick_exit", "std::exit", "std::quick_exit", "std::_Exit"), "exit"),
    **dict.fromkeys(("abort", "std::abort"), "abort"),
    **dict.fromkeys(("assert", "BOOST_ASSERT", "std::terminate"), "assert"),
    **dict.fromkeys(("signal", "sigaction", "std::signal", "sigset"), "signal"),
    **dict.fromkeys(("sleep", "usleep", "nanosleep", "clock_nanosleep"), "sleep"),
    **dict.fromkeys(("std::this_thread::sleep_for", "std::this_thread::sleep_until"), "sleep"),
    **dict.fromkeys(("boost::this_thread::sleep", "boost::this_thread::sleep_for"), "sleep"),
    **dict.fromkeys(("getchar", "std::getchar", "getwchar", "getch", "wgetch", "kbhit"), "getchar"),
    **dict.fromkeys(("scanf", "std::scanf", "vscanf", "gets", "isatty"), "getchar"),
    **dict.fromkeys(("socket", "recvfrom", "sendto", "getaddrinfo", "gethostbyname"), "socket"),
    **dict.fromkeys(("tcsetattr", "tcgetattr", "cfsetispeed", "cfsetospeed", "ioctl", "cfmakeraw"), "serial"),
    **dict.fromkeys(("fopen", "freopen", "open", "opendir", "std::fopen", "std::freopen", "mkstemp"), "file"),
    **dict.fromkeys(("system", "popen", "fork", "vfork", "execl", "execv", "execvp", "std::system"), "process"),
    **dict.fromkeys(("pthread_create", "std::async", "boost::async"), "thread"),
    **dict.fromkeys(("typeid", "dynamic_cast", "boost::dynamic_pointer_cast", "std::dynamic_pointer_cast"), "rtti"),
}
"""Functions, each with the rule for its call."""
TYPES: dict[str, str] = {
    **dict.fromkeys(("std::thread", "boost::thread", "boost::thread_group", "std::jthread", "pthread_t"), "thread"),
    **dict.fromkeys(("std::ifstream", "std::ofstream", "std::fstream", "ifstream", "ofstream", "fstream"), "file"),
    **dict.fromkeys(("boost::asio::io_service", "boost::asio::ip::tcp::socket"), "socket"),
    **dict.fromkeys(("boost::asio::ip::udp::socket", "sockaddr_in", "boost::asio::io_context"), "socket"),
    **dict.fromkeys(("boost::asio::deadline_timer", "boost::asio::steady_timer"), "socket"),
    **dict.fromkeys(("boost::condition_variable", "boost::condition_variable_any", "boost::condition"), "thread"),
    **dict.fromkeys(("std::condition_variable", "std::condition_variable_any", "boost::barrier"), "thread"),
    **dict.fromkeys(("serial::Serial", "boost::asio::serial_port", "termios"), "serial"),
}
"""Types, each with the rule for its declarations."""
_EMPTY = ("std::thread", "boost::thread", "boost::thread_group", "std::jthread", "pthread_t")
"""Members of these types start nothing until they are used."""
_MEMBERS = frozenset(name for name, rule in TYPES.items() if rule in ("socket", "serial", "thread")) - {*_EMPTY}
_METHODS = {"create_thread": "thread"}
_KEYBOARD = frozenset(("stdin", "STDIN_FILENO", "cin"))
"""Arguments for standard input; std::cin is found at any place."""
GROWING = frozenset(
    ("push_back", "emplace_back", "resize", "insert", "emplace", "reserve", "push_front", "append", "assign")
)
"""Methods of containers that allocate."""
_HANDLE_CALLS = {
    "advertise": "publish",
    "subscribe": "subscribe",
    "advertiseService": "serve",
    "serviceClient": "call",
    **dict.fromkeys(("param", "getParam", "getParamCached", "setParam", "hasParam", "deleteParam"), "parameter"),
}
_FUNCTIONS = {
    "ros::topic::waitForMessage": "subscribe",
    "ros::service::waitForService": "call",
    "ros::service::call": "call",
    **{f"ros::param::{name}": "parameter" for name in ("get", "param", "set", "has", "del", "getCached")},
}
_DECLARED = {"message_filters::Subscriber": "subscribe", "SimpleActionServer": "action", "SimpleActionClient": "action"}
_CALLBACK_TAKERS = (
    "subscribe",
    "advertiseService",
    "createTimer",
    "createWallTimer",
    "registerCallback",
    "addCallback",
)
_LOST = ("ERROR", "friend_declaration")
_CONDITIONS = ("preproc_if", "preproc_ifdef", "preproc_elif", "preproc_else", "preproc_elifdef")


def read_source(path: Path, source: bytes) -> SourceFile:
    """Read a source.

    Args:
        path: of the file, for places.
        source: its text.

    Raises:
        UsageError: tree-sitter is not installed.
    """
    return _Reader(path).read(_parse(source).root_node)


class _Around(NamedTuple):
    """A node around the current one.

    Attributes:
        end: byte at which it ends.
        kind: its type.
        function: name of the innermost function around it, or of itself.
    """

    end: int
    kind: str
    function: str


class _Reader:
    """Walks a tree once, and knows the nodes around each node."""

    def __init__(self, path: Path) -> None:
        self._file = SourceFile(path)
        self._around: list[_Around] = []
        self._kinds: Counter[str] = Counter()  # of the nodes around
        self._given: set[int] = set()  # positions of lambdas that are passed directly to ROS
        self._lost: list[int] = []  # ends of code that the parser does not understand, such as a class with a macro
        self._later: list[Node] = []
        self._skip = 0
        self._readers = {
            "preproc_include": self._include,
            "preproc_def": self._macro,
            "call_expression": self._call,
            "throw_statement": self._throw,
            "catch_clause": self._catch,
            "new_expression": self._new,
            "declaration": self._declaration,
            "field_declaration": self._member,
            "binary_expression": self._binary,
            "function_definition": self._function,
            "class_specifier": self._class,
            "struct_specifier": self._class,
            "qualified_identifier": self._qualified,
        }

    def read(self, root: Node) -> SourceFile:
        """Read a whole file."""
        for node in _nodes(root):
            if node.start_byte < self._skip:
                continue
            while self._around and self._around[-1].end <= node.start_byte:
                self._kinds[self._around.pop().kind] -= 1
            while self._lost and self._lost[-1] <= node.start_byte:
                self._lost.pop()
            if node.type == "ERROR" or node.is_missing:
                self._file.unparsed += 1
            reader = self._readers.get(node.type)
            if reader is not None:
                reader(node)
            self._enter(node)
            if node.type in _LOST and node != root:
                self._lost.append(node.end_byte)
        for call in self._later:  # names can be constants that are defined later
            self._name_of_call(call)
        return self._file

    def _enter(self, node: Node) -> None:
        kind = node.type
        if kind in _CONDITIONS and not _is_guard(node):
            condition = node.child_by_field_name("condition")
            if kind == "preproc_if" and _text(condition).strip() == "0":
                self._skip = node.end_byte
            self._go_into(node)
        elif kind == "function_definition":
            self._go_into(node, _last(_function_name(node)))
        elif kind == "lambda_expression":
            self._go_into(node, "lambda" if node.start_byte in self._given else "")
        elif kind in ("class_specifier", "struct_specifier", "compound_statement"):
            self._go_into(node)

    def _go_into(self, node: Node, function: str = "") -> None:
        outer = self._around[-1].function if self._around else ""
        self._around.append(_Around(node.end_byte, node.type, function or outer))
        self._kinds[node.type] += 1

    # -- rules ---------------------------------------------------------------------------------------------------------

    def _place(self, node: Node) -> SourcePlace:
        return SourcePlace(self._file.path, node.start_point[0] + 1, node.start_point[1] + 1)

    def _meet(self, rule: str, node: Node, message: str) -> None:
        function = self._around[-1].function if self._around else ""
        self._file.met.append(Met(rule, self._place(node), message, function))

    def _include(self, node: Node) -> None:
        path = node.child_by_field_name("path")
        text = _text(path)
        if path is None or path.type not in ("string_literal", "system_lib_string") or len(text) < 3:
            return  # by a macro, which only the compiler knows
        conditional = any(self._kinds[kind] for kind in _CONDITIONS)
        self._file.includes.append(Include(text[1:-1].strip(), self._place(node), conditional))

    def _macro(self, node: Node) -> None:
        value = _text(node.child_by_field_name("value")).strip()
        if len(value) > 1 and value[0] == value[-1] == '"':
            self._file.constants[_text(node.child_by_field_name("name"))] = value[1:-1]

    def _throw(self, node: Node) -> None:
        self._meet("throw", node, _text(node).split("\n", 1)[0].rstrip(";")[:80])

    def _catch(self, node: Node) -> None:
        self._meet("catch", node, f"catch {_text(node.child_by_field_name('parameters'))[:70]}")

    def _new(self, node: Node) -> None:
        self._meet("heap-in-callback", node, _text(node).split("\n", 1)[0][:60])
        self._object(node, _plain(_text(node.child_by_field_name("type"))))

    def _qualified(self, node: Node) -> None:
        if _text(node) == "std::cin":
            self._meet("getchar", node, "std::cin")

    def _binary(self, node: Node) -> None:
        if _text(node.child_by_field_name("operator")) == ">>" and _text(node.child_by_field_name("left")) == "cin":
            self._meet("getchar", node, "cin")

    def _member(self, node: Node) -> None:
        kind = _plain(_text(node.child_by_field_name("type")))
        if kind in _MEMBERS and node.child_by_field_name("declarator") is not None:
            self._object(node, kind)

    def _function(self, node: Node) -> None:
        name = _function_name(node)
        declarator = _declarator(node)
        if declarator is None:
            return
        first = _parameters(declarator)
        self._file.parameters.setdefault(_last(name), _text(first[0]) if first else "")
        around = {kind for kind, count in self._kinds.items() if count}
        is_static = any(each.type == "storage_class_specifier" and _text(each) == "static" for each in node.children)
        if not is_static and around.isdisjoint(("class_specifier", "struct_specifier")):
            self._file.owners.add(_last(name.rpartition("::")[0]))
        if name == "main" and not self._around:
            self._file.mains.append(Main(self._place(node), _taken(first)))

    def _class(self, node: Node) -> None:
        if node.child_by_field_name("body") is not None:
            self._file.classes.add(_plain(_text(node.child_by_field_name("name"))))

    def _object(self, node: Node, kind: str) -> None:
        """Record that an object of a type is made."""
        rule = TYPES.get(kind)
        if rule is not None:
            self._meet(rule, node, f"a {kind}")

    def _declaration(self, node: Node) -> None:
        kind = _plain(_text(node.child_by_field_name("type")))
        self._object(node, kind)
        words = {_text(each) for each in node.children if each.type.endswith(("specifier", "qualifier"))}
        declared = [each for each in node.children_by_field_name("declarator") if _is_variable(each)]
        for each in declared:
            name = _variable_name(each)
            value = each.child_by_field_name("value") if each.type == "init_declarator" else None
            if value is not None and value.type == "argument_list":
                value = value.named_children[0] if value.named_child_count == 1 else None
            constant = self._constant(value)
            if constant is not None and words & {"const", "constexpr"}:
                self._file.constants[name] = constant
            self._keep(each, name, words)
            self._declared_name(node, each, kind)

    def _keep(self, node: Node, name: str, words: set[str]) -> None:
        """Record a variable that outlives its scope."""
        kinds = {kind for kind, count in self._kinds.items() if count} - set(_CONDITIONS)
        if not kinds and not words & {"constexpr", "extern", "using", "typedef"} and not self._lost:
            self._file.has_objects = True
        if words & {"const", "constexpr", "extern", "using", "typedef"} or not name:
            return
        if not kinds and not self._lost:
            self._meet("global-state", node, f"{name} is a variable of the whole program")
        elif "static" in words and kinds & {"function_definition", "lambda_expression"}:
            self._meet("static-local", node, f"{name} outlives its function")

    # -- calls and names -----------------------------------------------------------------------------------------------

    def _call(self, node: Node) -> None:
        function = node.child_by_field_name("function")
        if function is None:
            return
        if function.type == "field_expression":
            self._method(node, function)
            return
        name = _plain(_text(function))
        rule = CALLS.get(name)
        if rule is not None:
            self._meet(rule, node, f"{name}()" if rule != "rtti" else name)
        elif _reads_keyboard(name, [_text(each) for each in _arguments(node)]):
            self._meet("getchar", node, f"{name}()")
        self._object(node, name)  # an unnamed object: std::thread(work).detach()
        if name in _FUNCTIONS:
            self._later.append(node)

    def _method(self, node: Node, function: Node) -> None:
        name = _plain(_text(function.child_by_field_name("field")))
        if name in _METHODS:
            self._meet(_METHODS[name], node, f"{name}()")
        if _text(function.child_by_field_name("argument")) == "cin":
            self._meet("getchar", node, f"cin.{name}()")
        if name in GROWING:
            self._meet("heap-in-callback", node, f"{name}()")
        if name in _CALLBACK_TAKERS:
            for argument in _arguments(node):
                self._given |= {argument.start_byte} if argument.type == "lambda_expression" else set()
                self._file.callbacks.update(_functions_in(argument))
        if name in _HANDLE_CALLS:
            self._later.append(node)

    def _name_of_call(self, node: Node) -> None:
        function = node.child_by_field_name("function")
        if function is None:
            return
        arguments = _arguments(node)
        if function.type != "field_expression":
            if arguments:
                self._use(_FUNCTIONS[_plain(_text(function))], node, arguments, _template(function))
            return
        field_node = function.child_by_field_name("field")
        call = _plain(_text(field_node))
        if call == "subscribe" and len(arguments) > 1 and _constant_text(arguments[1]) is not None:
            arguments = arguments[1:]  # a filter's, whose first argument is the node's handle
        elif (call == "subscribe" and len(arguments) < 3) or not arguments:
            return  # options, which contain the name
        if call == "param" and len(arguments) > 2:
            default = self._constant(arguments[2])
            if default is not None:
                self._file.defaults[_text(arguments[1])] = default
        self._use(_HANDLE_CALLS[call], node, arguments, _template(field_node))

    def _declared_name(self, node: Node, declarator: Node, kind: str) -> None:
        """Record the name in the constructor of a filter's subscriber or an action's server."""
        found = next((role for name, role in _DECLARED.items() if kind.endswith(name)), None)
        value = declarator.child_by_field_name("value") if declarator.type == "init_declarator" else None
        if found is None or value is None or value.type != "argument_list":
            return
        given = [each for each in value.named_children if each.type != "comment"]
        start = next((at for at, each in enumerate(given) if self._constant(each) is not None), None)
        if start is not None:
            self._use(found, node, given[start:], _template(node.child_by_field_name("type")))

    def _use(self, kind: str, node: Node, arguments: list[Node], kind_text: str) -> None:
        name = self._constant(arguments[0])
        queue = None
        if kind in ("publish", "subscribe") and len(arguments) > 1 and arguments[1].type == "number_literal":
            digits = _text(arguments[1]).rstrip("uUlL")
            queue = int(digits) if digits.isdigit() and len(digits) < _LONGEST_NUMBER else None
        place = self._place(node)
        if kind == "subscribe" and len(arguments) > 2:
            self._file.handlers[place] = next(iter(_functions_in(arguments[2])), "") or _lambda_type(arguments[2])
        self._file.names.append(GraphName(kind, name, _text(arguments[0])[:60], place, _type_name(kind_text), queue))

    def _constant(self, node: Node | None) -> str | None:
        return _constant_text(node, self._file.constants)


def _constant_text(node: Node | None, constants: dict[str, str] | None = None) -> str | None:
    """Return the text of an expression, if it is known before the program runs."""
    if node is None or (node.end_byte - node.start_byte > _LONGEST_NAME and not node.type.endswith("string_literal")):
        return None
    inner = [each for each in node.named_children if each.type != "comment"]
    if node.type == "string_literal":
        return "".join(map(_text, inner))
    if node.type == "raw_string_literal":
        return next((_text(each) for each in inner if each.type == "raw_string_content"), None)
    if node.type in ("identifier", "qualified_identifier"):
        return None if constants is None else constants.get(_last(_text(node)))
    if node.type == "call_expression" and _last(_plain(_text(node.child_by_field_name("function")))) == "string":
        given = _arguments(node)
        return _constant_text(given[0], constants) if len(given) == 1 else None
    if node.type in ("parenthesized_expression", "concatenated_string") or (
        node.type == "binary_expression" and _text(node.child_by_field_name("operator")) == "+"
    ):
        parts = [_constant_text(each, constants) for each in inner]
        return None if None in parts or not parts else "".join(filter(None, parts))
    return None


_LONGEST_TEXT = 8_000  # bytes of a node whose text is read
_LONGEST_NUMBER = 19  # digits of the length of a queue
_LONGEST_NAME = 500  # bytes of an expression that is examined


def _reads_keyboard(function: str, given: list[str]) -> bool:
    """Return True if a call reads the keyboard: its arguments are standard input, or 0 for read()."""
    return not _KEYBOARD.isdisjoint(given) or (function in ("read", "::read") and given[:1] == ["0"])


def _arguments(call: Node) -> list[Node]:
    given = call.child_by_field_name("arguments")
    return [] if given is None else [each for each in given.named_children if each.type != "comment"]


def _functions_in(argument: Node) -> list[str]:
    """Return names of the functions in an argument: `&Class::method`, `function`, or in a bind."""
    while argument.type == "call_expression" and _calls_bind(argument):
        given = _arguments(argument)
        if not given:
            return []
        argument = given[0]
    if argument.type == "pointer_expression":
        return [_last(_text(argument).lstrip("& "))]
    return [_last(_text(argument))] if argument.type in ("identifier", "qualified_identifier") else []


def _calls_bind(call: Node) -> bool:
    return _last(_plain(_text(call.child_by_field_name("function")))) == "bind"


def _lambda_type(argument: Node) -> str:
    """Return the type of a lambda's parameter, after a blank, which no name of a function has."""
    declarator = argument.child_by_field_name("declarator") if argument.type == "lambda_expression" else None
    first = [] if declarator is None else _parameters(declarator)
    return f" {_text(first[0])}" if first else ""


def _declarator(node: Node) -> Node | None:
    """Return the function's declarator, after `*` and `&` of its return type."""
    found = node.child_by_field_name("declarator")
    while found is not None and found.type in ("pointer_declarator", "reference_declarator"):
        found = found.child_by_field_name("declarator") or next(iter(found.named_children), None)
    return found if found is not None and found.type == "function_declarator" else None


def _function_name(node: Node) -> str:
    declarator = _declarator(node)
    return "" if declarator is None else _plain(_text(declarator.child_by_field_name("declarator")))


def _parameters(declarator: Node) -> list[Node]:
    given = declarator.child_by_field_name("parameters")
    return [] if given is None else [each for each in given.named_children if each.type.endswith("declaration")]


def _taken(parameters: list[Node]) -> str:
    """Return the parameters of a main; see `Main`."""
    texts = ["".join(_text(each).split()) for each in parameters]
    if not texts or texts == ["void"]:
        return "nothing"
    if len(texts) == 2 and texts[0].startswith("int") and texts[1].replace("const", "").startswith("char"):
        return "arguments"
    return ", ".join(_text(each) for each in parameters)


def _is_variable(node: Node) -> bool:
    """Return True if a declarator declares a variable, not a function."""
    seen: Node | None = node
    while seen is not None:
        if seen.type == "function_declarator":
            return False
        if seen.type in ("identifier", "qualified_identifier"):
            return True
        seen = seen.child_by_field_name("declarator") or next(
            (each for each in seen.named_children if each.type.endswith(("declarator", "identifier"))), None
        )
    return False


def _variable_name(node: Node) -> str:
    seen = node
    while seen.type not in ("identifier", "qualified_identifier"):
        inner = seen.child_by_field_name("declarator") or next(
            (each for each in seen.named_children if each.type.endswith(("declarator", "identifier"))), None
        )
        if inner is None:
            return ""
        seen = inner
    return _text(seen)


def _is_guard(node: Node) -> bool:
    """Return True if a condition is the guard around a whole header."""
    name = node.child_by_field_name("name")
    if node.parent is None or node.parent.type != "translation_unit" or name is None:
        return False
    first = next((each for each in node.named_children if each.type not in ("comment", "identifier")), None)
    if first is None or first.type != "preproc_def":
        return False
    return _text(first.child_by_field_name("name")) == _text(name)


def _template(node: Node | None) -> str:
    """Return the first template argument of a name, as written."""
    text = _text(node)
    start = text.find("<")
    return "" if start < 0 or len(text) > _LONGEST_NAME else text[start + 1 : text.rfind(">")].strip()


def _type_name(text: str) -> str:
    """Convert a message's C++ type to ROS's form: "const std_msgs::StringConstPtr &" to "std_msgs/String"."""
    for word in ("const", "boost::shared_ptr", "std::shared_ptr", "ros::MessageEvent", "typename", "&", "*", "<", ">"):
        text = text.replace(word, " ")
    words = text.split()
    name = words[0] if words else ""
    parts = name.lstrip(":").split("::")
    if len(parts) > 2 and parts[2] in ("ConstPtr", "Ptr", "Request", "Response"):
        parts = parts[:2]
    if len(parts) != 2:
        return ""
    return f"{parts[0]}/{parts[1].removesuffix('Ptr').removesuffix('Const')}"


def type_of(parameter: str) -> str:
    """Return the message type of a callback, from its first parameter as written; empty when it is not known."""
    return _type_name(parameter)


def _plain(text: str) -> str:
    """Return a name without template arguments, blanks, and the `::` of the outermost namespace."""
    return "".join(text.partition("<")[0].split()).removeprefix("::")


def _last(name: str) -> str:
    return name.rpartition("::")[2]


# -- the parser --------------------------------------------------------------------------------------------------------


def _parse(source: bytes) -> Tree:
    """Return the tree of a source.

    Raises:
        UsageError: tree-sitter is not installed.
    """
    return _parser().parse(source)


def _nodes(root: Node) -> Iterator[Node]:
    """Yield a node and all nodes below it, in the order of the source, at any depth."""
    cursor = root.walk()
    while True:
        node = cursor.node
        if node is not None:
            yield node
        if cursor.goto_first_child():
            continue
        while not cursor.goto_next_sibling():
            if not cursor.goto_parent():
                return


def _text(node: Node | None) -> str:
    """Return the source text of a node; empty for None, and for a text longer than any name."""
    if node is None or node.end_byte - node.start_byte > _LONGEST_TEXT:
        return ""
    return "" if node.text is None else node.text.decode("utf-8", errors="replace")


def _parser() -> Parser:
    try:
        import tree_sitter
        import tree_sitter_cpp
    except ImportError:
        raise UsageError(HINT) from None
    return tree_sitter.Parser(tree_sitter.Language(tree_sitter_cpp.language()))
