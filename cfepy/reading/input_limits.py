"""Size limits for each kind of input, so that no input from others fills the memory or never ends.

The limits are far above the sizes of real missions, bags and launch files. An input above a limit is refused with an
error that names the file, the limit and the remedy. `cfepy.reading.input_files` opens and reads the files.
docs/reference/security.md lists the limits.
"""

from __future__ import annotations

# YAML in any file
YAML_BYTES = 32 << 20
YAML_VALUES = 100_000  # with its aliases expanded
YAML_DEPTH = 100  # nesting of lists and mappings
YAML_DIGITS = 1_000  # of a number

# XML: launch files, robot descriptions, manifests, test reports
XML_BYTES = 8 << 20
XML_DEPTH = 100
XML_TAGS = 100_000
XML_ENTITY = 100  # characters of an entity, which cannot contain other entities

# launch files
LAUNCH_INCLUDES_DEEP = 64  # for a file that includes itself
LAUNCH_WORK = 1_000_000  # tags read, each with its arguments, variables and remappings in effect
LAUNCH_NUMBER = 1e9  # seconds, and numbers of retries
LAUNCH_NAME = 1_000  # characters of a name with its namespaces
LAUNCH_FILE_BYTES = 32 << 20  # of the files in textfile= and binfile=
SUBSTITUTED_CHARACTERS = 1_000_000  # of a text after substitution
SUBSTITUTED_IN_ALL = 50_000_000  # in all texts of a launch

# $(eval ...) and rad(...)
EXPRESSION_CHARACTERS = 10_000
EXPRESSION_DEPTH = 60  # nesting of operators and brackets
EXPRESSION_STEPS = 100_000
EXPRESSION_SIZE = 100_000  # characters and items of a value
EXPRESSION_WORK = 5_000_000  # characters and items of all intermediate values
EXPRESSION_BITS = 8_192  # of a whole number

# message definitions
DEFINITION_BYTES = 4 << 20
MESSAGE_FIELDS = 5_000  # of a type, including its nested types
MESSAGE_DEPTH = 50  # nesting of types
MESSAGE_VALUES = 8_000_000  # in arrays of fixed length, including nested types

# compressed data
BAG_CHUNK_BYTES = 256 << 20  # of a bag's chunk after decompression
JOURNAL_FRAME_BYTES = 128 << 20
JOURNAL_VALUES = 1_000_000  # of a frame
JOURNAL_FILE_BYTES = 64 << 20  # of a file in a journal
JOURNAL_FILES_BYTES = 512 << 20  # of all files in a journal

# data that external programs send to a run: XML-RPC, TCPROS, and viewer messages
RPC_BYTES = 8 << 20  # of a request or a response
RPC_VALUES = 100_000
RPC_DEPTH = 100  # nesting of values
RPC_CALLS = 1_000  # of a system.multicall
RPC_ANSWER_BYTES = 32 << 20  # of the response to a multicall, approximately
ROS_NAME = 1_000  # characters of the name of a topic, service, node or parameter, of a type and of a URI
ROS_REGISTRATIONS = 10_000  # of all external nodes at a master that a mission serves
ROS_NAMES = 1_000  # of topics and services that external programs add to a run: each takes a MsgId
ROS_PUBLISHERS = 256  # external publishers that a mission connects to
ROS_CALLS = 256  # pending external calls of a service
PARAMETER_BYTES = 32 << 20  # of a parameter; the tables that keep it over a reset have less room
PARAMETER_DEPTH = 100  # nesting of lists and namespaces, including those of its name
PEER_CONNECTIONS = 512  # to all nodes of a mission and its master
UNFINISHED_BYTES = 64 << 20  # of incomplete messages, over all connections of a server
TCPROS_HEADER_BYTES = 16 << 20  # it includes message definitions
TCPROS_FRAME_BYTES = 32 << 20
VIEWER_ROWS = 10_000  # of a list in a viewer message
JSON_BRACKETS = 200_000  # lists and objects in a viewer message
JSON_VALUES = 2_000_000

# texts read line by line
LINE_FILE_BYTES = 16 << 20  # scripts of commands
STARTUP_BYTES = 256 << 10  # startup scripts

# programs, which are read but not executed
PYTHON_BYTES = 4 << 20  # of a Python source
PYTHON_WORDS = 200_000  # words and signs of a Python source
PYTHON_DEPTH = 1_000  # nesting of expressions and blocks in the syntax tree
CPP_BYTES = 4 << 20  # of a C or C++ source or header
CPP_FILES = 5_000  # sources and headers of a node
CPP_FILES_BYTES = 16 << 20  # of all of them
OBJECT_BYTES = 256 << 20  # of a shared object
TABLE_BYTES = 64 << 20  # of a table file and other files that cFE writes
JSON_DEPTH = 100

# CMakeLists.txt, including those of subfolders
CMAKE_BYTES = 1 << 20  # of a file
CMAKE_COMMANDS = 100_000  # executed commands, including loops
CMAKE_CHARACTERS = 10_000_000  # of words read and generated
CMAKE_DEPTH = 40  # nesting of blocks, calls, subfolders and brackets
CMAKE_FILES = 50_000  # files and folders matched against patterns

# a compiler started by a check or a build, for one source
COMPILER_SECONDS = 120  # of CPU time
COMPILER_BYTES = 4 << 30  # of memory
