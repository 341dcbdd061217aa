// Time that /clock says: what goes with it, and what does not.
#include <cmath>
#include <cstdio>

#include <ros/ros.h>

static double rounded(double seconds) { return std::floor(seconds * 10 + 0.5) / 10; }

static int  g_ticks = 0, g_wall_ticks = 0;
static bool g_even = true;
static void tick(const ros::TimerEvent &event)
{
    ++g_ticks;
    g_even = g_even && std::fabs((event.current_real - event.current_expected).toSec()) < 0.1;
}
static void wall_tick(const ros::WallTimerEvent &) { ++g_wall_ticks; }

int main(int argc, char **argv)
{
    ros::init(argc, argv, "sim_time");
    ros::NodeHandle nh;
    std::printf("P| simulated %d system %d use %d\n", ros::Time::isSimTime(), ros::Time::isSystemTime(),
                ros::Time::useSystemTime());
    std::printf("P| valid %d at %.1f\n", ros::Time::isValid(), ros::Time::now().toSec());
    const bool too_early = ros::Time::waitForValid(ros::WallDuration(0.2));
    std::printf("P| valid within 0.2 s %d\n", too_early);
    ros::Timer timer = nh.createTimer(ros::Duration(0.5), tick);
    ros::WallTimer wall = nh.createWallTimer(ros::WallDuration(0.1), wall_tick);
    ros::param::set("/tick", 1);
    std::printf("P| sleep before the first tick %d\n", ros::Duration(0.3).sleep());
    std::printf("P| valid %d, from 100 %d\n", ros::Time::isValid(), ros::Time::now() >= ros::Time(100));
    const ros::Time     begin = ros::Time::now();
    const ros::WallTime wall_begin = ros::WallTime::now();
    const bool slept = ros::Duration(1.0).sleep();
    const ros::Time     end = ros::Time::now();
    const ros::WallTime wall_end = ros::WallTime::now();
    std::printf("P| slept %d %.1f s, on the wall half of it: %d\n", slept, rounded((end - begin).toSec()),
                std::fabs((wall_end - wall_begin).toSec() - 0.5) < 0.2);
    std::printf("P| no time to sleep: %d %d\n", ros::Duration(0.0).sleep(), ros::Duration(-1.0).sleep());
    std::printf("P| until the past %d\n", ros::Time::sleepUntil(begin));
    const ros::Time next = ros::Time::now() + ros::Duration(0.5);
    const bool until = ros::Time::sleepUntil(next);
    std::printf("P| until %d %d\n", until, ros::Time::now() >= next);
    ros::Rate rate(5);
    const ros::Time cycles = ros::Time::now();
    for (int i = 0; i < 5; ++i)
    {
        rate.sleep();
    }
    std::printf("P| five cycles of 0.2 s: %.1f\n", rounded((ros::Time::now() - cycles).toSec()));
    timer.stop();
    timer.start();
    wall.stop();
    wall.start();
    g_ticks = g_wall_ticks = 0;
    g_even = true;
    const ros::WallTime wall_spun = ros::WallTime::now();
    const ros::Time spun = ros::Time::now() + ros::Duration(2.2);
    while (ros::ok() && ros::Time::now() < spun)
    {
        ros::spinOnce();
        ros::WallDuration(0.002).sleep();
    }
    const double on_the_wall = (ros::WallTime::now() - wall_spun).toSec();
    std::printf("P| ticks %d, each in time %d; as many on the wall as it took %d\n", g_ticks, g_even,
                std::fabs(g_wall_ticks - on_the_wall * 10) < 2);
    while (ros::Time::now() < spun + ros::Duration(0.3))
    {
        ros::WallDuration(0.001).sleep();
    }
    ros::param::set("/back", 1);
    const bool back = ros::Duration(1000.0).sleep();
    std::printf("P| back %d, before 100 %d\n", back, ros::Time::now() < ros::Time(100));
    g_ticks = 0;
    timer.setPeriod(ros::Duration(0.5));
    const ros::Time again = ros::Time::now() + ros::Duration(1.2);
    while (ros::ok() && ros::Time::now() < again)
    {
        ros::spinOnce();
        ros::WallDuration(0.002).sleep();
    }
    std::printf("P| ticks after that %d\n", g_ticks);
    std::printf("P| wall time is another %d\n", ros::WallTime::now().toSec() > 1e6);
    ros::param::set("/end", 1);
    ros::Time::setNow(ros::Time(7, 5));
    std::printf("P| set %d\n", ros::Time::now() >= ros::Time(7, 5));
}
