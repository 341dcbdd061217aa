// What nodes use of Boost's locks, rows and loops. It compiles against Boost itself as well: locks.txt is what it prints
// there.
#include <cstdio>
#include <string>
#include <vector>

#include <boost/algorithm/clamp.hpp>
#include <boost/circular_buffer.hpp>
#include <boost/foreach.hpp>
#include <boost/thread.hpp>
#include <boost/thread/lock_guard.hpp>
#include <boost/thread/locks.hpp>
#include <boost/thread/mutex.hpp>
#include <boost/thread/recursive_mutex.hpp>

static void locks()
{
    boost::mutex mutex;
    {
        boost::mutex::scoped_lock lock(mutex);
        std::printf("%d %d\n", lock.owns_lock(), lock.mutex() == &mutex);
        lock.unlock();
        std::printf("%d\n", lock.owns_lock());
        lock.lock();
    }
    {
        boost::lock_guard<boost::mutex>  guard(mutex);
    }
    boost::unique_lock<boost::mutex> later(mutex, boost::defer_lock);
    std::printf("%d", later.owns_lock());
    std::printf(" %d", later.try_lock());
    boost::unique_lock<boost::mutex> taken(std::move(later));
    std::printf(" %d %d\n", later.owns_lock(), taken.owns_lock());
    boost::mutex *released = taken.release();
    std::printf("%d %d\n", released == &mutex, taken.mutex() == nullptr);
    boost::unique_lock<boost::mutex> adopted(mutex, boost::adopt_lock);
    std::printf("%d %d\n", adopted ? 1 : 0, !adopted);
    adopted.unlock();
    boost::unique_lock<boost::mutex> tried(mutex, boost::try_to_lock);
    std::printf("%d\n", tried.owns_lock());

    boost::recursive_mutex                         again;
    boost::recursive_mutex::scoped_lock            outer(again);
    boost::unique_lock<boost::recursive_mutex>     inner(again);
    boost::lock_guard<boost::recursive_mutex>      third(again);
    boost::recursive_mutex::scoped_try_lock        fourth(again);
    std::printf("%d %d\n", inner.owns_lock(), fourth.owns_lock());
    std::printf("%d\n", boost::this_thread::get_id() == boost::this_thread::get_id());
}

template <class Buffer>
static void show(const Buffer &row)
{
    std::printf("%zu of %zu:", row.size(), row.capacity());
    for (typename Buffer::const_iterator at = row.begin(); at != row.end(); ++at)
    {
        std::printf(" %d", *at);
    }
    std::printf(" %d %d\n", row.empty(), row.full());
}

static void rows()
{
    boost::circular_buffer<int> row, three(3), filled(4, 9), part(5, 2, 7);
    row.push_back(1);
    show(row);
    for (int i = 0; i < 5; ++i)
    {
        three.push_back(i);
        show(three);
    }
    three.push_front(10);
    show(three);
    three.pop_back();
    three.push_front(11);
    three.push_front(12);
    show(three);
    std::printf("%d %d %d %d\n", three.front(), three.back(), three[1], three.at(2));
    three.set_capacity(5);
    three.push_back(13);
    show(three);
    three.set_capacity(2);
    show(three);
    filled[2] = 1;
    filled.rset_capacity(2);
    show(filled);
    show(part);
    part.pop_front();
    std::printf("%zu\n", part.reserve());
    part.clear();
    show(part);
    part.push_front(3);
    part.push_back(4);
    for (boost::circular_buffer<int>::reverse_iterator at = part.rbegin(); at != part.rend(); ++at)
    {
        *at *= 2;
    }
    std::printf("%d %td\n", *(part.begin() + 1), part.end() - part.begin());
    try
    {
        part.at(2) = 1;
    }
    catch (const std::out_of_range &error)
    {
        std::printf("%s\n", error.what());
    }
}

int main()
{
    locks();
    rows();
    std::vector<int> numbers{1, 2, 3};
    BOOST_FOREACH (int &number, numbers)
    {
        number *= 2;
    }
    BOOST_FOREACH (const int number, numbers)
        std::printf("%d ", number);
    std::printf("\n");
    std::printf("%g %g %d\n", boost::algorithm::clamp(1.5, 0, 1), boost::algorithm::clamp(-1.0, -0.5, 3), boost::algorithm::clamp(5, 1, 9));
    std::printf("%d\n", boost::algorithm::clamp(5, 9, 1, [](int a, int b) { return a > b; }));
}
