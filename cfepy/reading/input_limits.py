"""How large an input may become: a limit for each kind, so that no file of somebody else's fills memory or never ends.

The limits are far above what missions, bags and launch files have. What exceeds one is refused with an error that names
the file, the limit, and what to do. `cfepy.reading.input_files` reads the files. docs/reference/security.md lists the
limits.
"""

from __future__ import annotations

# YAML, of whatever file
YAML_BYTES = 32 << 20
YAML_VALUES = 100_000  # with its aliases written out
YAML_DEPTH = 100  # lists and mappings inside each other
YAML_DIGITS = 1_000  # of a number

# XML: launch files, descriptions of robots, manifests, reports of tests
XML_BYTES = 8 << 20
XML_DEPTH = 100
XML_TAGS = 100_000
XML_ENTITY = 100  # characters of an entity, which has no other one inside

# launch files
LAUNCH_INCLUDES_DEEP = 64  # a file that includes itself would go on for ever
LAUNCH_WORK = 1_000_000  # tags that are read, each with the arguments, variables and remappings that hold there
LAUNCH_NUMBER = 1e9  # seconds, and times to try again
LAUNCH_NAME = 1_000  # characters of a name with its namespaces
LAUNCH_FILE_BYTES = 32 << 20  # of what textfile= and binfile= name
SUBSTITUTED_CHARACTERS = 1_000_000  # of a text whose substitutions are made
SUBSTITUTED_IN_ALL = 50_000_000  # in all texts of a launch

# $(eval ...) and rad(...)
EXPRESSION_CHARACTERS = 10_000
EXPRESSION_DEPTH = 60  # operators and brackets inside each other
EXPRESSION_STEPS = 100_000
EXPRESSION_SIZE = 100_000  # characters and items of a value
EXPRESSION_WORK = 5_000_000  # characters and items of all values on the way
EXPRESSION_BITS = 8_192  # of a whole number

# message definitions
DEFINITION_BYTES = 4 << 20
MESSAGE_FIELDS = 5_000  # of a type, those of types inside it counted
MESSAGE_DEPTH = 50  # types inside each other
MESSAGE_VALUES = 8_000_000  # in arrays of fixed length, with those of the types inside them

# what is packed
BAG_CHUNK_BYTES = 256 << 20  # of a bag's chunk when it is unpacked
JOURNAL_FRAME_BYTES = 128 << 20
JOURNAL_VALUES = 1_000_000  # of a frame
JOURNAL_FILE_BYTES = 64 << 20  # of a file that a journal carries
JOURNAL_FILES_BYTES = 512 << 20  # of all of them

# what programs outside send to a run: XML-RPC, TCPROS, and messages of viewers
RPC_BYTES = 8 << 20  # of a request or an answer
RPC_VALUES = 100_000
RPC_DEPTH = 100  # values inside each other
RPC_CALLS = 1_000  # of a system.multicall
RPC_ANSWER_BYTES = 32 << 20  # of the answer to one, about
ROS_NAME = 1_000  # characters of a name of a topic, service, node or parameter, of a type and of a URI
ROS_REGISTRATIONS = 10_000  # of all nodes outside at a master that a mission serves
ROS_NAMES = 1_000  # of topics and services that programs outside bring into a run: each takes a MsgId
ROS_PUBLISHERS = 256  # outside, with which a mission connects
ROS_CALLS = 256  # of a service, from outside, that wait for their answers
PARAMETER_BYTES = 32 << 20  # of a parameter; the tables that keep it over a reset have room for less
PARAMETER_DEPTH = 100  # lists and namespaces inside each other, with those of its name
PEER_CONNECTIONS = 512  # with all nodes of a mission and its master
UNFINISHED_BYTES = 64 << 20  # of messages that are not whole yet, over all connections of a server
TCPROS_HEADER_BYTES = 16 << 20  # definitions of messages are in it
TCPROS_FRAME_BYTES = 32 << 20
VIEWER_ROWS = 10_000  # of a list in a message of a viewer
JSON_BRACKETS = 200_000  # lists and objects in a message of a viewer
JSON_VALUES = 2_000_000

# texts that are read line by line
LINE_FILE_BYTES = 16 << 20  # scripts of commands
STARTUP_BYTES = 256 << 10  # startup scripts

# programs: they are read, not executed
PYTHON_BYTES = 4 << 20  # of a Python source
PYTHON_WORDS = 200_000  # words and signs of a Python source
PYTHON_DEPTH = 1_000  # expressions and blocks inside each other, as the syntax tree counts them
CPP_BYTES = 4 << 20  # of a C or C++ source or header
CPP_FILES = 5_000  # sources and headers of a node
CPP_FILES_BYTES = 16 << 20  # of all of them
OBJECT_BYTES = 256 << 20  # of a shared object
TABLE_BYTES = 64 << 20  # of a table file, and of other files that cFE writes
JSON_DEPTH = 100

# CMakeLists.txt, those of subfolders counted with that of the package
CMAKE_BYTES = 1 << 20  # of a file
CMAKE_COMMANDS = 100_000  # that are carried out, loops included
CMAKE_CHARACTERS = 20_000_000  # of words that are read and made
CMAKE_DEPTH = 40  # blocks, calls, subfolders and brackets inside each other
CMAKE_FILES = 50_000  # files and folders that patterns look at

# a compiler that a check or a build starts, for one source
COMPILER_SECONDS = 120  # of the processor
COMPILER_BYTES = 4 << 30  # of memory
