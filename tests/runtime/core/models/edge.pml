/* An edge of the graph (runtime/core/edge.h): ring.h with batches of BATCH, the promise that nothing
 * earlier will come, and doorbell.h.
 *
 * The producer sends ITEMS samples and promises each; the consumer sleeps while there is none. It is
 * checked that every sample arrives once, complete and in order, that all that is promised is there
 * when the promise is read first, that no slot is filled while it is read, and that the consumer
 * never sleeps for ever.
 */
#define SLOTS 2
#define THREADS 2
#define VARIABLES 8
#define VALUES (2 * ITEMS + 1)
#include "weak_memory.pml"

#define PRODUCER 0
#define CONSUMER 1
#define PUBLISHED 0
#define FREED 1
#define PROMISED 2
#define BELL 3
#define SLOT(i) (4 + (i) % SLOTS)
#define READS(i) (6 + (i) % SLOTS)

byte rings; /* how often the bell was rung */

inline ring_bell() {
  exchange(PRODUCER, BELL, RING_ACQUIRES, RING_RELEASES, x, rings + 1);
  rings++
}

proctype producer() {
  byte pick, other, x, tail, limit = SLOTS;
  do
  :: tail < ITEMS ->
     do
     :: tail == limit ->
        load(PRODUCER, FREED, CLAIM_ACQUIRES, x);
        limit = x + SLOTS
     :: else -> break
     od;
     plain_store(PRODUCER, SLOT(tail), READS(tail), tail + 1);
     tail++;
     store(PRODUCER, PUBLISHED, PUBLISH_RELEASES, tail);
     ring_bell();
     store(PRODUCER, PROMISED, PROMISE_RELEASES, tail);
     ring_bell()
  :: else -> break
  od
}

proctype consumer() {
  byte pick, other, x, heard, promised, head, seen, next_free = BATCH;
  do
  :: head < ITEMS ->
     load(CONSUMER, BELL, LISTEN_ACQUIRES, heard);
     load(CONSUMER, PROMISED, PROMISED_ACQUIRES, promised);
     do
     :: head == seen ->
        load(CONSUMER, PUBLISHED, FRONT_ACQUIRES, seen);
        if
        :: head == seen -> break
        :: else
        fi
     :: else ->
        plain_load(CONSUMER, SLOT(head), READS(head), x);
        head++;
        assert(x == head);
        if
        :: head == next_free || head == seen ->
           store(CONSUMER, FREED, FREE_RELEASES, head);
           next_free = head + BATCH
        :: else
        fi
     od;
     assert(head >= promised);
     if
     :: head < ITEMS -> /* wait(heard) */
        do
        :: value[AT(BELL, newest[BELL])] != heard ->
           load(CONSUMER, BELL, WAIT_ACQUIRES, x);
           if
           :: x != heard -> break
           :: else
           fi
        od
     :: else
     fi
  :: else -> break
  od
}

init {
  atomic {
    run producer();
    run consumer()
  }
}
