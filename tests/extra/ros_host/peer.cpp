// A node in C++ on Debian's roscpp: each of topics, services and parameters both ways.
#include <cstdio>

#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>

namespace {
ros::Publisher answers;

void hear(const std_msgs::String::ConstPtr& message) {
  std_msgs::String answer;
  answer.data = message->data + " of C++";
  answers.publish(answer);
}

bool turn(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  response.success = request.data;
  response.message = "turned";
  return true;
}
}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "cpp_peer");
  ros::NodeHandle node;
  answers = node.advertise<std_msgs::String>("/answers", 10);
  ros::Subscriber questions = node.subscribe("/questions", 10, hear);
  ros::ServiceServer turning = node.advertiseService("/turn", turn);
  ros::ServiceClient client = node.serviceClient<std_srvs::SetBool>("/mission/turn");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  client.waitForExistence();
  std_srvs::SetBool request;
  request.request.data = true;
  const bool good = client.call(request);
  std::string given;
  node.getParam("/given", given);
  std::printf("called %d %s, given %s\n", good, request.response.message.c_str(), given.c_str());
  std::fflush(stdout);
  ros::waitForShutdown();
}
