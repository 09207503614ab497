/* The cell in which the newest value wins (runtime/core/latest_value.h).
 *
 * The writer publishes VALUES_SENT values of two parts. It is checked that the reader gets whole
 * values, never an older one than before, the last one in the end, and that no buffer is filled while
 * it is read.
 */
#define THREADS 2
#define VARIABLES 10
#define VALUES (2 * VALUES_SENT + 2)
#include "weak_memory.pml"

#define WRITER 0
#define READER 1
#define WAITING 0
#define FIRST_PART(i) (1 + (i))
#define SECOND_PART(i) (4 + (i))
#define READS(i) (7 + (i))
#define UNREAD 4
#define INDEX(x) ((x) & 3)

proctype writer() {
  byte pick, other, x, sent, back = 0;
  do
  :: sent < VALUES_SENT ->
     sent++;
     plain_store(WRITER, FIRST_PART(back), READS(back), sent);
     plain_store(WRITER, SECOND_PART(back), READS(back), sent);
     exchange(WRITER, WAITING, PUBLISH_ACQUIRES, PUBLISH_RELEASES, x, back | UNREAD);
     back = INDEX(x)
  :: else -> break
  od
}

proctype reader() {
  byte pick, other, x, y, last, front = 2;
  do
  :: last < VALUES_SENT ->
     load(READER, WAITING, LOOK_ACQUIRES, x);
     if
     :: x & UNREAD ->
        exchange(READER, WAITING, LATEST_ACQUIRES, LATEST_RELEASES, x, front);
        front = INDEX(x);
        plain_load(READER, FIRST_PART(front), READS(front), x);
        plain_load(READER, SECOND_PART(front), READS(front), y);
        assert(x == y && x > last);
        last = x
     :: else
     fi
  :: else -> break
  od
}

init {
  atomic {
    value[AT(WAITING, 0)] = 1; /* the buffer in between */
    run writer();
    run reader()
  }
}
