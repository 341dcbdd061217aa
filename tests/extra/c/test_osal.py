"""OS_*: tasks, waiting, timers and clocks, as C code sees them; status codes are NASA's."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.extra.c.building import (
    compile_c,
    console_of,
    digest_of,
    fly,
    fly_c,
    needs_compiler,
    said,
    write_mission,
)

pytestmark = needs_compiler
HEADER = '#include "osal.h"\n#define DID(call) SAY("%d", (int)(call))\n'


def results(folder: Path, body: str, *, before: str = "", tasks: str = "thread") -> list[str]:
    """Return the output of a main function's body. DID prints the result of a call."""
    return said(fly_c(folder, f"{HEADER}{before}\nvoid TEST_Main(void)\n{{\n{body}\n}}\n", 5, tasks=tasks))


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_task_of_osal_belongs_to_no_application(tmp_path: Path, tasks: str) -> None:
    if tasks == "greenlet":
        pytest.importorskip("greenlet")
    before = """
    static void child(void)
    {
        uint32_t app;
        TaskInfo info;
        OS_TaskGetInfo(OS_TaskGetId(), &info);
        SAY("%s %d %zu %d", info.name, info.priority, info.stack_size, CFE_ES_GetAppID(&app) != 0);
    }
    """
    body = """
        Id id = 9;
        TaskInfo info;
        DID(OS_TaskCreate(NULL, "KID", child, NULL, 4096, 60, 0));
        DID(OS_TaskCreate(&id, NULL, child, NULL, 1, 0, 0));
        DID(OS_TaskCreate(&id, "KID", NULL, NULL, 4096, 60, 0));
        DID(OS_TaskCreate(&id, "12345678901234567890", child, NULL, 4096, 60, 0));
        DID(OS_TaskCreate(&id, "KID", child, NULL, 0, 60, 0));
        DID(id);
        DID(OS_TaskCreate(&id, "KID", child, NULL, 5000, 60, 0));
        OS_TaskDelay(10);
        info.name[0] = 'x';
        DID(OS_TaskGetInfo(id, &info));
        SAY("[%s] %d", info.name, OS_TaskDelete(id));
    """
    said = results(tmp_path, body, before=before, tasks=tasks)
    assert said == [*("-2", "-2", "-2", "-13", "-40", "9", "0"), "KID 60 5000 1", "-16", "[] -16"]


def test_delay_lasts_its_time_and_0_ms_use_time(tmp_path: Path) -> None:
    body = """
        Time then, now;
        OS_GetMonotonicTime(&then);
        for (int i = 0; i < 50; i++)
            OS_TaskDelay(1);
        OS_GetMonotonicTime(&now);
        DID(now - then);
        do {
            OS_TaskDelay(0);
            OS_GetMonotonicTime(&now);
        } while (now < then + 600000);
        SAY("polled");
    """
    assert results(tmp_path, body) == ["500010", "polled"]


def test_wait_of_no_time_keeps_less_urgent_tasks_back(tmp_path: Path) -> None:
    before = """
    static volatile int turns;
    static void less_urgent(void)
    {
        for (;;) {
            turns++;
            OS_TaskDelay(1);
        }
    }
    static const long nothing[2];
    extern int usleep(unsigned), nanosleep(const long *, long *);
    """
    body = """
        Id id;
        OS_TaskCreate(&id, "LESS", less_urgent, NULL, 4096, 200, 0);
        OS_TaskDelay(5);
        for (int way = 0; way < 3; way++) {
            int before = turns;
            for (int i = 0; i < 20000; i++)
                way == 0 ? OS_TaskDelay(0) : way == 1 ? usleep(0) : nanosleep(nothing, NULL);
            SAY("%d", turns - before);
            OS_TaskDelay(5);
        }
    """
    assert results(tmp_path, body, before=before) == ["0", "0", "0"]


def test_task_runs_on_a_stack_of_the_application(tmp_path: Path) -> None:
    before = """
    static char stack[16384] __attribute__((aligned(16)));
    static void child(void)
    {
        char local;
        SAY("%d", &local > stack && &local < stack + sizeof stack);
    }
    """
    body = """
        Id id = 9;
        DID(OS_TaskCreate(&id, "KID", child, stack, sizeof stack - 16, 60, 0));
        DID(id);
        DID(OS_TaskCreate(&id, "KID", child, stack, sizeof stack, 60, 0));
        OS_TaskDelay(10);
    """
    assert results(tmp_path, body, before=before) == ["-1", "0", "0", "1"]


def test_a_delete_handler_is_called_and_system_data_is_the_id(tmp_path: Path) -> None:
    before = """
    static void gone(void) { SAY("gone"); }
    static void child(void)
    {
        unsigned long self = pthread_self();
        Id found = 0;
        DID(OS_TaskFindIdBySystemData(&found, &self, sizeof self));
        DID(found == OS_TaskGetId());
        DID(OS_TaskFindIdBySystemData(&found, NULL, 8));
        DID(OS_TaskFindIdBySystemData(&found, &self, 4));
        self = 1;
        DID(OS_TaskFindIdBySystemData(&found, &self, sizeof self));
        OS_TaskInstallDeleteHandler(gone);
        OS_TaskDelay(1000);
    }
    """
    body = """
        Id id, other;
        OS_TaskCreate(&id, "KID", child, NULL, 4096, 60, 0);
        OS_TaskDelay(10);
        DID(OS_TaskGetIdByName(&other, "KID"));
        DID(other == id);
        DID(OS_TaskSetPriority(id, 70));
        DID(OS_TaskDelete(id));
        DID(OS_TaskGetIdByName(&other, "KID"));
    """
    said = results(tmp_path, body, before=before)
    assert said == ["0", "1", "-2", "-2", "-17", "0", "1", "0", "gone", "0", "-17"]


def test_semaphores(tmp_path: Path) -> None:
    body = """
        Id bin = 9, count;
        SemInfo info;
        DID(OS_BinSemCreate(&bin, "B", 0x80000000u, 0));
        DID(bin);
        DID(OS_BinSemCreate(&bin, "B", 1, 0));
        DID(OS_BinSemCreate(NULL, "C", 1, 0));
        DID(OS_BinSemTimedWait(bin, 10));
        DID(OS_BinSemTimedWait(bin, 10));
        DID(OS_BinSemTimedWait(0, 10));
        DID(OS_BinSemGive(bin));
        DID(OS_BinSemGetInfo(bin, &info));
        SAY("%s %d", info.name, info.value);
        DID(OS_BinSemGetInfo(bin, NULL));
        DID(OS_BinSemFlush(bin));
        DID(OS_CountSemCreate(&count, "C", 2, 0));
        DID(OS_CountSemTake(count));
        DID(OS_CountSemGetInfo(count, &info));
        DID(info.value);
        DID(OS_CountSemTimedWait(count, 5));
        DID(OS_CountSemTimedWait(count, 5));
        DID(OS_CountSemGive(count));
    """
    assert results(tmp_path, body) == [
        *("-20", "0", "0", "-2", "0", "-7", "-16", "0", "0", "B 1", "-2", "0"),
        *("0", "0", "0", "1", "0", "-7", "0"),
    ]


def test_mutexes_and_rw_locks(tmp_path: Path) -> None:
    body = """
        Id mutex, lock;
        Named named;
        DID(OS_MutSemCreate(&mutex, "M", 0));
        DID(OS_MutSemGive(mutex));
        DID(OS_MutSemTake(mutex));
        DID(OS_MutSemDelete(mutex));
        DID(OS_MutSemGetInfo(mutex, &named));
        SAY("%s", named.name);
        DID(OS_MutSemGive(mutex));
        DID(OS_MutSemDelete(mutex));
        DID(OS_RwLockCreate(&lock, "L", 0));
        DID(OS_RwLockReadTake(lock));
        DID(OS_RwLockReadGive(lock));
        DID(OS_RwLockWriteTake(lock));
        DID(OS_RwLockWriteGive(lock));
        DID(OS_RwLockDelete(lock));
        DID(OS_RwLockDelete(lock));
    """
    assert results(tmp_path, body) == [
        *("0", "-6", "0", "-6", "0", "M", "0", "0"),
        *("0", "0", "0", "0", "0", "0", "-16"),
    ]


def test_condition_variables(tmp_path: Path) -> None:
    before = """
    static Id var;
    static void child(void)
    {
        OS_CondVarLock(var);
        OS_CondVarSignal(var);
        OS_CondVarUnlock(var);
    }
    """
    body = """
        Id id;
        Time until;
        OS_CondVarCreate(&var, "V", 0);
        DID(OS_CondVarLock(var));
        OS_TaskCreate(&id, "KID", child, NULL, 4096, 60, 0);
        DID(OS_CondVarWait(var));
        OS_GetLocalTime(&until);
        until += 50 * 10000;
        DID(OS_CondVarTimedWait(var, &until));
        DID(OS_CondVarTimedWait(var, NULL));
        DID(OS_CondVarUnlock(var));
    """
    assert results(tmp_path, body, before=before) == ["0", "0", "-4", "-2", "0"]


def test_queues(tmp_path: Path) -> None:
    body = """
        Id id = 9;
        size_t size = 77;
        char text[8] = "";
        DID(OS_QueueCreate(&id, "Q", 0, 4, 0));
        DID(id);
        DID(OS_QueueCreate(&id, "Q", 51, 4, 0));
        DID(OS_QueueCreate(&id, "Q", 1, 0, 0));
        DID(OS_QueueCreate(&id, "Q", 1, 4, 0));
        DID(OS_QueueGet(id, text, 8, &size, 0));
        DID(size);
        DID(OS_QueueGet(id, text, 8, &size, 20));
        DID(OS_QueueGet(id, text, 8, &size, -5));
        DID(OS_QueueGet(id, text, 3, &size, 0));
        DID(OS_QueuePut(id, "abc", 4, 0));
        DID(OS_QueuePut(id, "abc", 4, 0));
        DID(OS_QueuePut(id, "abcd", 5, 0));
        DID(OS_QueueGet(id, text, 8, &size, -1));
        SAY("%zu %s", size, text);
        DID(OS_QueuePut(id, NULL, 4, 0));
        DID(OS_QueuePut(id, "a", 0, 0));
        DID(OS_QueueGet(id, text, 8, NULL, 0));
    """
    assert results(tmp_path, body) == [
        *("-1", "0", "-11", "-40", "0", "-8", "0", "-10", "-10", "-11"),
        *("0", "-9", "-11", "0", "4 abc", "-2", "-40", "-2"),
    ]


def test_timers_and_time_bases(tmp_path: Path) -> None:
    before = """
    static int ticks, sum;
    static Id made;
    static void tick(Id id) { ticks += id == made; }
    static void add(Id id, void *arg)
    {
        TimerInfo info;
        sum += *(int *)arg * (OS_TimerGetInfo(id, &info) == -35);
    }
    static uint32_t sync(Id id)
    {
        OS_TaskDelay(10);
        return 10000;
    }
    """
    body = """
        Id base, timer, outside;
        uint32_t accuracy = 0, run;
        int seven = 7;
        TimerInfo info;
        TimeBaseInfo about;
        DID(OS_TimerCreate(&made, "T", &accuracy, tick));
        DID(accuracy > 0);
        DID(OS_TimerCreate(&made, "T", NULL, tick));
        DID(OS_TimerSet(made, 0, 0));
        DID(OS_TimerSet(made, 10000, 10000));
        OS_TaskDelay(55);
        DID(OS_TimerGetInfo(made, &info));
        SAY("%d ticks of %s, %u", ticks, info.name, info.interval);
        OS_TimeBaseCreate(&base, "B", NULL);
        OS_TimeBaseSet(base, 10000, 10000);
        DID(OS_TimerAdd(&timer, "A", base, add, &seven));
        DID(OS_TimerSet(timer, 20000, 20000));
        OS_TaskDelay(95);
        SAY("sum %d", sum);
        DID(OS_TimeBaseGetInfo(base, &about));
        SAY("%s %u", about.name, about.interval);
        DID(OS_TimeBaseDelete(base));
        DID(OS_TimerDelete(timer));
        OS_TimeBaseCreate(&outside, "O", sync);
        OS_TaskDelay(35);
        DID(OS_TimeBaseGetFreeRun(outside, &run));
        DID(run);
        OS_TimeBaseDelete(outside); /* ES leaves it, and unloads the code of its function */
    """
    assert results(tmp_path, body, before=before) == [
        *("0", "1", "-2", "-29", "0", "0", "5 ticks of T, 10000", "0", "0", "sum 28"),
        *("0", "B 10000", "-33", "0", "0", "30000"),
    ]


def test_clocks(tmp_path: Path) -> None:
    body = """
        Time now, later = 1234567890;
        DID(OS_GetLocalTime(NULL));
        DID(OS_SetLocalTime(NULL));
        DID(OS_SetLocalTime(&later));
        DID(OS_GetLocalTime(&now));
        DID(now >= later && now < later + 100);
        DID(OS_TimeFromRelativeMilliseconds(-1) == INT64_MAX);
        DID(OS_TimeFromRelativeMilliseconds(0));
        DID(OS_TimeToRelativeMilliseconds(OS_TimeFromRelativeMilliseconds(500)));
        DID(OS_TimeToRelativeMilliseconds(INT64_MAX));
        DID(OS_TimeToRelativeMilliseconds(5));
        OS_GetMonotonicTime(&now);
        do OS_GetMonotonicTime(&later); while (later < now + 1000);
        SAY("polled");
    """
    said = results(tmp_path, body)
    assert said == ["-2", "-2", "0", "0", "1", "1", "0", "499", "-1", "0", "polled"]


TALK = (
    HEADER
    + """
static Id queue, mutex;
static int sum;
static void child(void)
{
    size_t size;
    int number;
    while (OS_QueueGet(queue, &number, sizeof number, &size, 500) == 0) {
        OS_MutSemTake(mutex);
        sum += number;
        OS_MutSemGive(mutex);
    }
    DID(sum);
}
static void tick(Id id) { static int number; number++; OS_QueuePut(queue, &number, sizeof number, 0); }
void TEST_Main(void)
{
    Id id, timer;
    uint32_t accuracy;
    OS_MutSemCreate(&mutex, "M", 0);
    OS_QueueCreate(&queue, "Q", 5, sizeof(int), 0);
    OS_TaskCreate(&id, "A", child, NULL, 8192, 60, 0);
    OS_TaskCreate(&id, "B", child, NULL, 8192, 60, 0);
    OS_TimerCreate(&timer, "T", &accuracy, tick);
    OS_TimerSet(timer, 1000, 1000);
    OS_TaskDelay(200);
    OS_TimerDelete(timer);
    OS_TaskDelay(1000);
}
"""
)


def test_run_is_the_same_on_threads_and_greenlets(tmp_path: Path) -> None:
    pytest.importorskip("greenlet")
    compile_c(tmp_path, "TEST", TALK)
    folder = write_mission(tmp_path, "TEST")
    assert digest_of(folder, "thread") == digest_of(folder, "greenlet")
    assert said(console_of(fly(folder))) == ["20100", "20100"]


def test_events_about_objects(tmp_path: Path) -> None:
    before = """
    static int refuse;
    static int32_t on_event(uint32_t event, Id id, void *data)
    {
        SAY("event %u kind %u %d", event, id >> 16, data == NULL);
        return event == 1 && refuse ? -43 : 0;
    }
    """
    body = """
        Id id = 9;
        DID(OS_RegisterEventHandler(NULL));
        DID(OS_RegisterEventHandler(on_event));
        DID(OS_BinSemCreate(&id, "B", 0, 0));
        OS_BinSemDelete(id);
        refuse = 1;
        DID(OS_BinSemCreate(&id, "B", 0, 0));
    """
    assert results(tmp_path, body, before=before)[:8] == [
        *("-2", "0", "event 1 kind 4 1", "event 2 kind 4 1", "0", "event 3 kind 4 1", "event 1 kind 4 1", "-43")
    ]
