"""Subscriptions of the Software Bus: which MsgIds go into which pipe (cfe_sb_api.c, CFE_SB_Subscribe and its kin).
Those that are not local to this processor are told to others, when somebody wants that (`cfepy.sb.reports`).
"""

from __future__ import annotations

from cfepy.sb import events as ev
from cfepy.sb.buffers import DESTINATION_BYTES, BufferServices
from cfepy.sb.pipe import Pipe
from cfepy.sb.reports import tell_one
from cfepy.sb.routing import GLOBAL, LOCAL, Destination, Route
from cfepy.status import CFE_SB_BAD_ARGUMENT, CFE_SB_MAX_DESTS_MET, CFE_SB_MAX_MSGS_MET, CfeError

DEFAULT_QOS = 0


class SubscriptionServices(BufferServices):
    """The CFE_SB_Subscribe* and CFE_SB_Unsubscribe* functions."""

    def subscribe(self, msg_id: int, pipe_id: int) -> None:
        """Let a MsgId into a pipe, with the default message limit of 4 (CFE_SB_Subscribe)."""
        self._subscribe(msg_id, pipe_id, self.config.sb_default_msg_limit, GLOBAL)

    def subscribe_ex(self, msg_id: int, pipe_id: int, qos: int = DEFAULT_QOS, msg_limit: int = 4) -> None:
        """Let a MsgId into a pipe (CFE_SB_SubscribeEx).

        Args:
            msg_id: the message.
            pipe_id: a pipe of the calling application.
            qos: priority, and reliability times 256 (CFE_SB_Qos_t); told to other processors, not used on this one.
            msg_limit: messages of this MsgId that may wait in the pipe.

        Raises:
            CfeError: CFE_SB_BAD_ARGUMENT, CFE_SB_MAX_MSGS_MET (MsgIds), CFE_SB_MAX_DESTS_MET (pipes of the MsgId),
                CFE_SB_BUF_ALOC_ERR (the message pool has no room).
        """
        self._subscribe(msg_id, pipe_id, msg_limit, GLOBAL, qos)

    def subscribe_local(self, msg_id: int, pipe_id: int, msg_limit: int) -> None:
        """As `subscribe_ex`, not told to other processors (CFE_SB_SubscribeLocal)."""
        self._subscribe(msg_id, pipe_id, msg_limit, LOCAL)

    def unsubscribe(self, msg_id: int, pipe_id: int) -> None:
        """Take a MsgId out of a pipe (CFE_SB_Unsubscribe); the messages that wait there stay.

        Raises:
            CfeError: CFE_SB_BAD_ARGUMENT for a bad MsgId or pipe. Not being subscribed is an event, not an error.
        """
        self._unsubscribe(msg_id, pipe_id, GLOBAL)

    def unsubscribe_local(self, msg_id: int, pipe_id: int) -> None:
        """As `unsubscribe` (CFE_SB_UnsubscribeLocal)."""
        self._unsubscribe(msg_id, pipe_id, LOCAL)

    def _unsubscribe(self, msg_id: int, pipe_id: int, scope: int) -> None:
        app = self.caller_name()
        pipe = self.find_pipe(pipe_id)
        if pipe is None:
            text = f"Unsubscribe Err:Invalid Pipe Id Msg=0x{msg_id:x},Pipe={pipe_id},app={app}"
            raise self._refused(ev.UNSUB_INV_PIPE_EID, text)
        if self.is_foreign(pipe):
            text = f"Unsubscribe Err:Caller({app}) is not the owner of pipe {pipe_id},Msg=0x{msg_id:x}"
            raise self._refused(ev.UNSUB_INV_CALLER_EID, text)
        if not self.is_valid_msg_id(msg_id):
            text = f"Unsubscribe Err:Bad Arg,MsgId 0x{msg_id:x},PipeId {pipe_id},app {app},scope {scope}"
            raise self._refused(ev.UNSUB_ARG_ERR_EID, text)
        self._remove(msg_id, pipe, app)

    def _remove(self, msg_id: int, pipe: Pipe, app: str) -> None:
        route = self.routes.get(msg_id)
        destination = route.find(pipe) if route is not None else None
        if route is None or destination is None:
            text = f"Unsubscribe Err:No subs for Msg 0x{msg_id:x} on {pipe.name},app {app}"
            self.report(ev.UNSUB_NO_SUBS_EID, ev.INFORMATION, text)
            return
        self.remove_destination(route, destination)
        text = f"Subscription Removed:Msg 0x{msg_id:x} on pipe {pipe.pipe_id},app {app}"
        self.report(ev.SUBSCRIPTION_REMOVED_EID, ev.DEBUG, text)

    def _subscribe(self, msg_id: int, pipe_id: int, limit: int, scope: int, qos: int = DEFAULT_QOS) -> None:
        pipe = self._check_subscription(msg_id, pipe_id, scope)
        app = self.caller_name()
        route = self._route_for(msg_id, pipe, app)
        if route.find(pipe) is not None:
            self.counters.duplicate_subscriptions += 1
            text = f"Duplicate Subscription,MsgId 0x{msg_id:x} on {pipe.name} pipe,app {app}"
            self.report(ev.DUP_SUBSCRIP_EID, ev.INFORMATION, text)
        else:
            self._add(route, pipe, limit & 0xFFFF, scope)  # C takes 16 bits
            text = f"Subscription Rcvd:MsgId 0x{msg_id:x} on PipeId {pipe_id},app {app}"
            self.report(ev.SUBSCRIPTION_RCVD_EID, ev.DEBUG, text)
        if scope == GLOBAL:
            tell_one(self, msg_id, pipe_id, qos)

    def _route_for(self, msg_id: int, pipe: Pipe, app: str) -> Route:
        """The route of a MsgId, made when there is none."""
        if msg_id not in self.routes and not self.routing.add_route(msg_id):
            limit_text = f"Max Msgs({self.config.sb_max_msg_ids})In Use"
            text = f"Subscribe Err:{limit_text},MsgId 0x{msg_id:x},pipe {pipe.name},app {app}"
            raise self._subscribe_error(ev.MAX_MSGS_MET_EID, CFE_SB_MAX_MSGS_MET, text)
        self.peaks.msg_ids = len(self.routes)
        return self.routes[msg_id]

    def _add(self, route: Route, pipe: Pipe, limit: int, scope: int) -> None:
        most = self.config.sb_max_dest_per_pkt
        if len(route.destinations) >= most:
            where = f"For Msg 0x{route.msg_id:x},pipe {pipe.name},app {self.caller_name()}"
            text = f"Subscribe Err:Max Dests({most})In Use {where}"
            raise self._subscribe_error(ev.MAX_DESTS_MET_EID, CFE_SB_MAX_DESTS_MET, text)
        try:
            block = self.take_block(DESTINATION_BYTES)
        except CfeError as error:
            text = f"Subscribe Err:Request for Destination Blk failed for Msg 0x{route.msg_id:x}"
            raise self._subscribe_error(ev.DEST_BLK_ERR_EID, error.status, text) from error
        route.add(Destination(pipe, limit, scope, block))
        self.subscriptions += 1
        self.peaks.subscriptions = max(self.peaks.subscriptions, self.subscriptions)
        self.note_growth()

    def _check_subscription(self, msg_id: int, pipe_id: int, scope: int) -> Pipe:
        app = self.caller_name()
        pipe = self.find_pipe(pipe_id)
        if pipe is None:
            text = f"Subscribe Err:Invalid Pipe Id,Msg=0x{msg_id:x},PipeId={pipe_id},App {app}"
            raise self._subscribe_error(ev.SUB_INV_PIPE_EID, CFE_SB_BAD_ARGUMENT, text)
        if self.is_foreign(pipe):
            text = f"Subscribe Err:Caller({app}) is not the owner of pipe {pipe_id},Msg=0x{msg_id:x}"
            raise self._subscribe_error(ev.SUB_INV_CALLER_EID, CFE_SB_BAD_ARGUMENT, text)
        if not self.is_valid_msg_id(msg_id):
            text = f"Subscribe Err:Bad Arg,MsgId 0x{msg_id:x},PipeId {pipe_id},app {app},scope {scope}"
            raise self._subscribe_error(ev.SUB_ARG_ERR_EID, CFE_SB_BAD_ARGUMENT, text)
        return pipe

    def _subscribe_error(self, event_id: int, status: int, text: str) -> CfeError:
        self.counters.subscribe_error += 1
        self.report(event_id, ev.ERROR, text)
        return CfeError(status, text)

    def _refused(self, event_id: int, text: str) -> CfeError:
        self.report(event_id, ev.ERROR, text)
        return CfeError(CFE_SB_BAD_ARGUMENT, text)
