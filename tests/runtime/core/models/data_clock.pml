/* The schedule of the data clock (runtime/core/data_clock.cpp), which readers take without a lock.
 *
 * The writer sets SCHEDULES schedules one after the other. It is checked that a reader gets no
 * mixture of two, and never an older one than before. Of data, wall and speed two are modelled.
 */
#define THREADS 2
#define VARIABLES 9
#define VALUES (SCHEDULES + 1)
#include "weak_memory.pml"

#define WRITER 0
#define READER 1
#define NEWEST 0
#define SLOTS 4
#define DATA(i) (1 + (i) % SLOTS)
#define SPEED(i) (5 + (i) % SLOTS)

proctype writer() {
  byte pick, other, next;
  do
  :: next < SCHEDULES ->
     next++;
     store(WRITER, DATA(next), DATA_RELEASES, next);
     store(WRITER, SPEED(next), SPEED_RELEASES, next);
     store(WRITER, NEWEST, NEWEST_RELEASES, next)
  :: else -> break
  od
}

proctype reader() {
  byte pick, other, before, after, data, speed, last;
  do
  :: last < SCHEDULES ->
     load(READER, NEWEST, BEFORE_ACQUIRES, before);
     load(READER, DATA(before), DATA_ACQUIRES, data);
     load(READER, SPEED(before), SPEED_ACQUIRES, speed);
     load(READER, NEWEST, AFTER_ACQUIRES, after);
     if
     :: after - before < SLOTS - 1 ->
        assert(data == speed && data >= last);
        last = data
     :: else
     fi
  :: else -> break
  od
}

init {
  atomic {
    run writer();
    run reader()
  }
}
