// std::cout and its kin of nodes that do not include <iostream>: see roscfe/standard_streams.h.
#include <iostream>
#include <new>

namespace
{

// Memory without a constructor: it is there before the objects of any source, and stays behind them, as std's.
template <class T>
union Place
{
    Place() {}
    ~Place() {}
    T stream;
};

} // namespace

extern "C" {
__attribute__((visibility("hidden"))) Place<std::istream> roscfe_cin;
__attribute__((visibility("hidden"))) Place<std::ostream> roscfe_cout, roscfe_cerr, roscfe_clog;
}

namespace
{

struct Opened
{
    std::ios_base::Init std; // first

    Opened()
    {
        ::new (&roscfe_cout.stream) std::ostream(std::cout.rdbuf());
        ::new (&roscfe_cerr.stream) std::ostream(std::cerr.rdbuf());
        ::new (&roscfe_clog.stream) std::ostream(std::clog.rdbuf());
        ::new (&roscfe_cin.stream) std::istream(std::cin.rdbuf());
        roscfe_cin.stream.tie(&roscfe_cout.stream);
        roscfe_cerr.stream.tie(&roscfe_cout.stream);
        roscfe_cerr.stream.setf(std::ios_base::unitbuf);
    }
};
const Opened g_opened __attribute__((init_priority(101))); // before objects of the node, which may write in their constructors

} // namespace
