/* The release and acquire operations of C++20 on few variables, as Kang et al. describe them ("A
 * promising semantics for relaxed-memory concurrency", POPL 2017), without promises.
 *
 * A variable is the list of all values that were ever stored to it. A thread has a view: the oldest
 * value of each variable that it may still read. A load picks any value that is not older; an
 * acquiring load takes over the view that a releasing store left with the value. A plain access that
 * could meet another value than the newest one is a data race, and a failed assertion.
 *
 * A model defines THREADS, VARIABLES and VALUES (stores to one variable, the first value included)
 * before it includes this file. It calls the inlines with a thread's number.
 */
#define OF(t, v) ((t) * VARIABLES + (v))
#define AT(v, i) ((v) * VALUES + (i))

byte newest[VARIABLES];                    /* index of the last value of each variable */
byte value[VARIABLES * VALUES];            /* variables begin with the value 0 */
byte view[THREADS * VARIABLES];            /* the oldest value of each variable that a thread may read */
byte left[VARIABLES * VALUES * VARIABLES]; /* the view that was left with each value */

inline join(t, v, i) {
  other = 0;
  do
  :: other < VARIABLES ->
     if
     :: left[AT(v, i) * VARIABLES + other] > view[OF(t, other)] ->
        view[OF(t, other)] = left[AT(v, i) * VARIABLES + other]
     :: else
     fi;
     other++
  :: else -> break
  od;
  other = 0
}

/* Appends a value, which a relaxed store leaves with a view of this variable alone. */
inline append(t, v, released, given) {
  newest[v]++;
  assert(newest[v] < VALUES);
  value[AT(v, newest[v])] = given;
  view[OF(t, v)] = newest[v];
  other = 0;
  do
  :: other < VARIABLES ->
     if
     :: released || other == v -> left[AT(v, newest[v]) * VARIABLES + other] = view[OF(t, other)]
     :: else
     fi;
     other++
  :: else -> break
  od;
  other = 0
}

inline load(t, v, acquired, got) {
  atomic {
    pick = view[OF(t, v)];
    do
    :: pick < newest[v] -> pick++
    :: break
    od;
    view[OF(t, v)] = pick;
    if
    :: acquired -> join(t, v, pick)
    :: else
    fi;
    got = value[AT(v, pick)];
    pick = 0
  }
}

inline store(t, v, released, given) {
  atomic { append(t, v, released, given) }
}

/* Reads the last value and stores another one in one step. What was left with the last value stays
 * with the new one: it continues the release sequence. */
inline exchange(t, v, acquired, released, got, given) {
  atomic {
    pick = newest[v];
    got = value[AT(v, pick)];
    view[OF(t, v)] = pick;
    if
    :: acquired -> join(t, v, pick)
    :: else
    fi;
    append(t, v, released, given);
    other = 0;
    do
    :: other < VARIABLES ->
       if
       :: left[AT(v, pick) * VARIABLES + other] > left[AT(v, newest[v]) * VARIABLES + other] ->
          left[AT(v, newest[v]) * VARIABLES + other] = left[AT(v, pick) * VARIABLES + other]
       :: else
       fi;
       other++
    :: else -> break
    od;
    other = 0;
    pick = 0
  }
}

/* Plain accesses. `reads` is a variable that counts the reads of v, so that a store is seen to race
 * with a read before it. */
inline plain_store(t, v, reads, given) {
  atomic {
    assert(view[OF(t, v)] == newest[v]);
    assert(view[OF(t, reads)] == newest[reads]);
    append(t, v, false, given)
  }
}

inline plain_load(t, v, reads, got) {
  atomic {
    assert(view[OF(t, v)] == newest[v]);
    got = value[AT(v, newest[v])];
    append(t, reads, false, 0)
  }
}
