// Timers whose callbacks are slow, several at once, those that are changed from a callback, and Rate after an overrun.
#include <cmath>
#include <cstdio>

#include <ros/callback_queue.h>
#include <ros/ros.h>

static ros::Time g_start;

// In tenths of a second since the start.
static int tenths(const ros::Time &time)
{
    return time.isZero() ? -1 : static_cast<int>(std::lround((time - g_start).toSec() * 10));
}

static void print(const char *name, const ros::TimerEvent &event)
{
    std::printf("P| %s at %d: last %d %d, now %d %d, took %ld\n", name, tenths(ros::Time::now()),
                tenths(event.last_expected), tenths(event.last_real), tenths(event.current_expected),
                tenths(event.current_real), std::lround(event.profile.last_duration.toSec() * 10));
}

static int g_calls = 0;

static void slow(const ros::TimerEvent &event)
{
    print("slow", event);
    if (++g_calls == 3)
    {
        ros::Duration(0.72).sleep();
    }
}

static void spin_for(double seconds)
{
    const ros::Time until = ros::Time::now() + ros::Duration(seconds);
    while (ros::Time::now() < until)
    {
        ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
    }
}

static void rates()
{
    ros::Rate rate(5);
    for (int work : {0, 1, 3, 0, 0, 5, 0, 0, 2, 0})
    {
        const ros::Time begin = ros::Time::now();
        ros::Duration(0.1 * work + 0.02).sleep();
        const bool      kept = rate.sleep();
        std::printf("P| rate with %d: %d, cycle %ld, in all %ld\n", work, kept,
                    std::lround(rate.cycleTime().toSec() * 10), std::lround((ros::Time::now() - begin).toSec() * 10));
    }
    std::printf("P| expected %.3f\n", rate.expectedCycleTime().toSec());
    rate.reset();
    std::printf("P| reset %d\n", rate.sleep());
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "timers");
    ros::NodeHandle nh;
    g_start          = ros::Time::now();
    ros::Timer timer = nh.createTimer(ros::Duration(0.2), slow);
    spin_for(2.3);
    timer.stop();
    std::printf("P| stopped %d %d\n", timer.hasStarted(), timer.hasPending());
    spin_for(0.5);
    g_start = ros::Time::now();
    timer.start();
    spin_for(0.5);
    timer.setPeriod(ros::Duration(0.3));
    spin_for(1.0);
    timer.setPeriod(ros::Duration(0.1), false);
    spin_for(0.65);
    timer.stop();
    std::printf("P| two\n");
    g_start      = ros::Time::now();
    ros::Timer b = nh.createTimer(ros::Duration(0.3), boost::function<void(const ros::TimerEvent &)>(
                                                          [](const ros::TimerEvent &event) { print("b", event); }));
    ros::Timer a = nh.createTimer(ros::Duration(0.2), boost::function<void(const ros::TimerEvent &)>(
                                                          [](const ros::TimerEvent &event) { print("a", event); }));
    spin_for(0.75);
    a.stop();
    b.stop();
    g_start         = ros::Time::now();
    ros::Timer once = nh.createTimer(
        ros::Duration(0.2),
        boost::function<void(const ros::TimerEvent &)>([](const ros::TimerEvent &event) { print("once", event); }),
        true);
    std::printf("P| once %d %d\n", once.hasStarted(), once.hasPending());
    spin_for(0.5);
    std::printf("P| once over %d %d\n", once.hasStarted(), once.hasPending());
    once.setPeriod(ros::Duration(0.1));
    once.start();
    spin_for(0.35);
    once.stop();
    once.start();
    spin_for(0.35);
    ros::Timer idle = nh.createTimer(
        ros::Duration(0.2),
        boost::function<void(const ros::TimerEvent &)>([](const ros::TimerEvent &event) { print("idle", event); }),
        false, false);
    spin_for(0.3);
    std::printf("P| idle %d %d\n", idle.hasStarted(), idle.hasPending());
    g_start = ros::Time::now();
    idle.start();
    ros::Duration(1.1).sleep(); // nobody spins
    spin_for(0.55);
    idle.stop();
    rates();
    return 0;
}
