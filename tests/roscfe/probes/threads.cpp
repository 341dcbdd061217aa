// Threads of a node: of the standard library, of Boost and of POSIX, and what ROS does in them.
#include <cerrno>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <future>
#include <mutex>
#include <shared_mutex>
#include <thread>

#include <pthread.h>
#include <semaphore.h>

#include <boost/thread.hpp>
#include <boost/thread/condition.hpp>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <std_srvs/Trigger.h>

using boost::posix_time::milliseconds;

// On cFE a thread begins 50 ms after it was started, so nothing that counts is closer together than 100 ms.
static void begin(const char *title)
{
    std::printf("P| -- %s\n", title);
}
static void say(const char *what, int value)
{
    std::printf("P| %s %d\n", what, value);
}

struct Told // of its thread's end
{
    ~Told() { say("thread's own object gone", id); }
    int id = 0;
};
static thread_local int g_mine = 7;

static void std_threads()
{
    begin("std");
    std::thread nothing;
    std::printf("P| %d %d\n", nothing.joinable(), std::this_thread::get_id() == std::thread::id());
    std::thread::id other;
    std::thread     one([&other](int by) {
        other = std::this_thread::get_id();
        g_mine += by;
        say("mine", g_mine);
        ros::Duration(0.2).sleep();
        say("slept", by); }, 3);
    const std::thread::id id = one.get_id();
    one.join();
    say("joined", id == other && id != std::this_thread::get_id());
    say("mine", g_mine);
    std::future<int> later = std::async(std::launch::async, [] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return 5;
    });
    say("not yet", later.wait_for(std::chrono::milliseconds(150)) == std::future_status::timeout);
    say("later", later.get());
    std::promise<int> promise;
    std::thread       fulfils([&promise] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        promise.set_value(9);
    });
    say("promised", promise.get_future().get());
    fulfils.join();
    std::promise<int> broken;
    std::thread([&broken] { broken.set_exception(std::make_exception_ptr(std::runtime_error("no"))); }).join();
    try
    {
        broken.get_future().get();
    }
    catch (const std::runtime_error &error)
    {
        std::printf("P| caught %s\n", error.what());
    }
    std::once_flag once;
    std::thread    first([&once] { std::call_once(once, [] {
        ros::Duration(0.2).sleep();
        say("once", 1); }); });
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    std::call_once(once, [] { say("once", 2); });
    say("after once", 0);
    first.join();
    std::thread gone([] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        say("detached", 1);
    });
    gone.detach();
    std::printf("P| %d\n", gone.joinable());
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    try
    {
        gone.join();
    }
    catch (const std::system_error &error)
    {
        std::printf("P| %d\n", error.code().value() == EINVAL);
    }
}

static void locks()
{
    begin("locks");
    std::mutex              mutex;
    std::condition_variable changed;
    std::deque<int>         queue;
    std::thread             consumer([&] {
        for (int value = 0; value != 3;)
        {
            std::unique_lock<std::mutex> lock(mutex);
            if (!changed.wait_for(lock, std::chrono::milliseconds(300), [&] { return !queue.empty(); }))
            {
                say("nothing", 0);
                continue;
            }
            value = queue.front();
            queue.pop_front();
            say("took", value);
        }
    });
    for (int i = 1; i <= 3; ++i)
    {
        ros::Duration(i == 2 ? 0.4 : 0.1).sleep();
        const std::lock_guard<std::mutex> guard(mutex);
        queue.push_back(i);
        changed.notify_one();
    }
    consumer.join();

    std::timed_mutex timed;
    timed.lock();
    std::thread waits([&] {
        say("in time", timed.try_lock_for(std::chrono::milliseconds(100)));
        say("in time", timed.try_lock_for(std::chrono::milliseconds(300)));
        timed.unlock();
    });
    ros::Duration(0.2).sleep();
    timed.unlock();
    waits.join();

    std::shared_mutex shared;
    shared.lock_shared();
    std::thread reader([&] {
        shared.lock_shared();
        say("reads, too", 1);
        shared.unlock_shared();
    });
    reader.join();
    std::thread writer([&] {
        say("may write", shared.try_lock());
        shared.lock();
        say("writes", 1);
        shared.unlock();
    });
    ros::Duration(0.1).sleep();
    shared.unlock_shared();
    writer.join();

    std::mutex held;
    held.lock();
    std::thread other([&] {
        say("held", held.try_lock());
        held.lock();
        say("held", 2);
        held.unlock();
    });
    ros::Duration(0.3).sleep(); // with the lock
    held.unlock();
    other.join();
}

static void boost_threads()
{
    begin("boost");
    boost::thread sleeper([] {
        try
        {
            boost::this_thread::sleep(boost::posix_time::seconds(60));
        }
        catch (const boost::thread_interrupted &)
        {
            say("interrupted", 1);
            throw;
        }
    });
    ros::Duration(0.1).sleep();
    say("joins", sleeper.timed_join(milliseconds(100)));
    sleeper.interrupt();
    sleeper.join();
    say("joinable", sleeper.joinable());

    boost::mutex     mutex;
    boost::condition never;
    boost::thread    waiter([&] {
        boost::mutex::scoped_lock lock(mutex);
        try
        {
            never.wait(lock);
        }
        catch (const boost::thread_interrupted &)
        {
            say("interrupted, has the lock", lock.owns_lock());
        }
        boost::this_thread::disable_interruption none;
        say("enabled", boost::this_thread::interruption_enabled());
    });
    ros::Duration(0.1).sleep();
    waiter.interrupt();
    waiter.join();

    boost::condition_variable changed;
    bool                      is_set = false;
    boost::thread_group       group;
    for (int i = 0; i < 3; ++i)
    {
        group.create_thread([&] {
            boost::unique_lock<boost::mutex> lock(mutex);
            while (!is_set)
            {
                changed.wait(lock);
            }
        });
    }
    ros::Duration(0.1).sleep();
    {
        boost::unique_lock<boost::mutex> lock(mutex);
        say("in time", changed.timed_wait(lock, milliseconds(100)));
        is_set = true;
        changed.notify_all();
    }
    group.join_all();
    say("all of", static_cast<int>(group.size()));

    boost::barrier barrier(2);
    boost::thread  there([&] {
        ros::Duration(0.1).sleep();
        barrier.wait();
    });
    barrier.wait();
    say("passed", 0);
    there.join();

    boost::thread_specific_ptr<Told> own;
    boost::thread                    with([&own] {
        own.reset(new Told);
        own->id = 4;
        say("has", own.get() != nullptr);
    });
    with.join();
    say("here", own.get() != nullptr);

    boost::shared_mutex shared;
    {
        boost::upgrade_lock<boost::shared_mutex>           upgrade(shared);
        boost::upgrade_to_unique_lock<boost::shared_mutex> unique(upgrade);
        boost::thread([&] { say("reads", shared.try_lock_shared()); }).join();
    }
    boost::thread([&] { say("reads", shared.try_lock_shared()); }).join();
    boost::thread moved, from([] { say("moved", 1); });
    moved = boost::move(from);
    std::printf("P| %d %d\n", from.joinable(), moved.joinable());
    moved.join();
}

static void *end_early(void *argument)
{
    say("begins", *static_cast<int *>(argument));
    pthread_exit(argument);
}

static void posix_threads()
{
    begin("posix");
    int       number = 12;
    pthread_t thread;
    say("created", pthread_create(&thread, nullptr, end_early, &number));
    void *result = nullptr;
    say("joined", pthread_join(thread, &result));
    say("result", result == &number);
    say("self", pthread_equal(pthread_self(), pthread_self()) != 0);

    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_ERRORCHECK);
    pthread_mutex_t careful;
    pthread_mutex_init(&careful, &attributes);
    say("locked", pthread_mutex_lock(&careful));
    say("again", pthread_mutex_lock(&careful) == EDEADLK);
    std::thread([&] { say("not its own", pthread_mutex_unlock(&careful) == EPERM); }).join();
    say("unlocked", pthread_mutex_unlock(&careful));
    pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
    pthread_mutex_t again;
    pthread_mutex_init(&again, &attributes);
    pthread_mutex_lock(&again);
    say("recursive", pthread_mutex_lock(&again));
    pthread_mutex_unlock(&again);
    std::thread([&] { say("still held", pthread_mutex_trylock(&again) == EBUSY); }).join();
    pthread_mutex_unlock(&again);
    std::thread([&] { say("free", pthread_mutex_trylock(&again)); }).join();

    pthread_mutex_t usual = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&usual);
    std::thread([&] { say("unlocked by another", pthread_mutex_unlock(&usual)); }).join();
    say("free", pthread_mutex_trylock(&usual));
    pthread_mutex_unlock(&usual);
    say("unlocked without a lock", pthread_mutex_unlock(&usual));
    pthread_rwlock_t both = PTHREAD_RWLOCK_INITIALIZER;
    pthread_rwlock_wrlock(&both);
    say("writes again", pthread_rwlock_wrlock(&both) == EDEADLK);
    say("reads what it writes", pthread_rwlock_rdlock(&both) == EDEADLK);
    pthread_rwlock_unlock(&both);

    sem_t semaphore;
    sem_init(&semaphore, 0, 1);
    sem_wait(&semaphore);
    say("empty", sem_trywait(&semaphore) == -1 && errno == EAGAIN);
    timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += 200000000;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    say("late", sem_timedwait(&semaphore, &until) == -1 && errno == ETIMEDOUT);
    std::thread giver([&] {
        ros::Duration(0.1).sleep();
        sem_post(&semaphore);
    });
    sem_wait(&semaphore);
    say("given", 0);
    giver.join();
}

static void ros_in_threads()
{
    begin("ros");
    ros::NodeHandle    node;
    ros::CallbackQueue own;
    boost::mutex       mutex;
    std::thread::id    main_id = std::this_thread::get_id();
    ros::Publisher     out     = node.advertise<std_msgs::Int32>("numbers", 10);
    ros::Subscriber    in      = node.subscribe<std_msgs::Int32>("numbers", 10, [&](const std_msgs::Int32::ConstPtr &message) {
        boost::mutex::scoped_lock lock(mutex);
        say(std::this_thread::get_id() == main_id ? "main heard" : "heard", message->data);
    });
    ros::ServiceServer server  = node.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(
        "slow", [&](std_srvs::Trigger::Request &, std_srvs::Trigger::Response &response) {
            ros::Duration(0.2).sleep();
            response.message = "done";
            response.success = true;
            return true;
        });
    while (out.getNumSubscribers() == 0)
    {
        ros::WallDuration(0.01).sleep();
    }
    begin("spinner");
    ros::AsyncSpinner spinner(1);
    spinner.start();
    std::thread publishes([&] {
        ros::Rate rate(5);
        for (int i = 0; i < 5; ++i)
        {
            std_msgs::Int32 number;
            number.data = i;
            out.publish(number);
            rate.sleep();
        }
    });
    {
        ros::Duration(0.3).sleep();
        boost::mutex::scoped_lock lock(mutex);
        ros::Duration(0.2).sleep(); // number 2 has to wait until the lock is free
        say("main has waited", 0);
    }
    publishes.join();
    ros::ServiceClient client = node.serviceClient<std_srvs::Trigger>("slow");
    std::thread        calls([&] {
        std_srvs::Trigger trigger;
        const bool        answered = client.call(trigger);
        say(trigger.response.message.c_str(), answered);
    });
    ros::Duration(0.1).sleep();
    say("main goes on", 0);
    calls.join();
    ros::Timer timer = node.createTimer(ros::Duration(0.1), [&](const ros::TimerEvent &) {
        say("timer in the spinner", std::this_thread::get_id() != main_id);
        ros::Duration(0.3).sleep(); }, true);
    ros::Duration(0.2).sleep();
    spinner.stop();
    say("stopped after the callback", 0);

    begin("spin in a thread");
    bool        is_over = false;
    std::thread spins([&] {
        while (!is_over)
        {
            ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
        }
    });
    for (int i = 10; i < 12; ++i)
    {
        std_msgs::Int32 number;
        number.data = i;
        out.publish(number);
        ros::Duration(0.1).sleep();
    }
    is_over = true;
    spins.join();

    begin("a queue of its own");
    ros::SubscribeOptions options = ros::SubscribeOptions::create<std_msgs::Int32>(
        "numbers", 10, [&](const std_msgs::Int32::ConstPtr &message) {
            say(std::this_thread::get_id() == main_id ? "main takes" : "takes", message->data); }, ros::VoidPtr(), &own);
    ros::Subscriber other = node.subscribe(options);
    while (out.getNumSubscribers() == 0)
    {
        ros::WallDuration(0.01).sleep();
    }
    ros::Duration(0.1).sleep();
    boost::thread empties([&] {
        while (node.ok())
        {
            own.callAvailable(ros::WallDuration(0.01));
        }
        std::printf("P| the node is to end\n");
    });
    begin("two queues");
    std_msgs::Int32 number;
    number.data = 20;
    out.publish(number);
    ros::Duration(0.1).sleep();
    ros::spinOnce();
    ros::Duration(0.1).sleep();
    ros::shutdown();
    empties.join();
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "probe");
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    ros::start();
    std_threads();
    locks();
    boost_threads();
    posix_threads();
    ros_in_threads();
    std::printf("P| end\n");
    return 0;
}
