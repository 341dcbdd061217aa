// The types of an action, by the names that actionlib has for them.
#ifndef ROSCFE_ACTIONLIB_ACTION_DEFINITION_H
#define ROSCFE_ACTIONLIB_ACTION_DEFINITION_H

#include <boost/shared_ptr.hpp>

namespace roscfe
{

template <class ActionSpec>
struct ActionTypes
{
    typedef typename ActionSpec::_action_goal_type     ActionGoal;
    typedef typename ActionSpec::_action_result_type   ActionResult;
    typedef typename ActionSpec::_action_feedback_type ActionFeedback;
    typedef typename ActionGoal::_goal_type            Goal;
    typedef typename ActionResult::_result_type        Result;
    typedef typename ActionFeedback::_feedback_type    Feedback;
};

} // namespace roscfe

#define ACTION_DEFINITION(ActionSpec)                                                                                  \
    typedef typename ::roscfe::ActionTypes<ActionSpec>::ActionGoal     ActionGoal;                                     \
    typedef typename ::roscfe::ActionTypes<ActionSpec>::ActionResult   ActionResult;                                   \
    typedef typename ::roscfe::ActionTypes<ActionSpec>::ActionFeedback ActionFeedback;                                 \
    typedef typename ::roscfe::ActionTypes<ActionSpec>::Goal           Goal;                                           \
    typedef typename ::roscfe::ActionTypes<ActionSpec>::Result         Result;                                         \
    typedef typename ::roscfe::ActionTypes<ActionSpec>::Feedback       Feedback;                                       \
    typedef boost::shared_ptr<const ActionGoal>                        ActionGoalConstPtr;                             \
    typedef boost::shared_ptr<const ActionResult>                      ActionResultConstPtr;                           \
    typedef boost::shared_ptr<const ActionFeedback>                    ActionFeedbackConstPtr;                         \
    typedef boost::shared_ptr<const Goal>                              GoalConstPtr;                                   \
    typedef boost::shared_ptr<const Result>                            ResultConstPtr;                                 \
    typedef boost::shared_ptr<const Feedback>                          FeedbackConstPtr;

namespace roscfe
{

// A part of a message, which keeps the message alive.
template <class Part, class Message>
boost::shared_ptr<const Part> part_of(const boost::shared_ptr<const Message> &message, const Part &part)
{
    return boost::shared_ptr<const Part>(message, &part);
}

} // namespace roscfe

#endif
