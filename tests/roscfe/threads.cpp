// A node of the profile host with threads of its own, which share numbers behind Boost's locks; with UNLOCKED, behind none.
#include <cstdio>
#include <thread>
#include <vector>

#include <boost/thread/lock_guard.hpp>
#include <boost/thread/locks.hpp>
#include <boost/thread/mutex.hpp>
#include <boost/thread/recursive_mutex.hpp>

static boost::mutex           g_mutex;
static boost::recursive_mutex g_again;
static long                   g_sum = 0, g_other = 0, g_tried = 0;

static void add()
{
    for (int i = 0; i < 2000; ++i)
    {
#ifdef UNLOCKED
        ++g_sum;
#else
        {
            boost::mutex::scoped_lock lock(g_mutex);
            ++g_sum;
        }
        {
            boost::lock_guard<boost::recursive_mutex>  outer(g_again);
            boost::unique_lock<boost::recursive_mutex> inner(g_again);
            ++g_other;
        }
        boost::unique_lock<boost::mutex> tried(g_mutex, boost::try_to_lock);
        if (tried.owns_lock())
        {
            ++g_tried;
        }
#endif
    }
}

int main()
{
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
    {
        threads.emplace_back(add);
    }
    for (std::thread &each : threads)
    {
        each.join();
    }
    std::printf("%ld %ld %d\n", g_sum, g_other, g_tried > 0);
    return 0;
}
