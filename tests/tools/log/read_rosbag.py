"""Reads a bag by ROS's own library, and writes what it contains as JSON.

  python3 read_rosbag.py FILE

{"compression": ..., "topics": {"/imu": {"type": ..., "messages": ..., "md5": ..., "first": "ns", "text": ...}}}:
"md5" is that of the definition in the bag, as ROS computes it; "text" is its last message, without the middle of a long one. A bag without an
index is refused. Exit status 77: skipped, with the reason.
"""

import json
import sys

try:
    import genpy.dynamic
    import rosbag
except ImportError as error:
    print(f"SKIPPED, NOT TESTED: python3-rosbag is not installed ({error})", file=sys.stderr)
    sys.exit(77)

with rosbag.Bag(sys.argv[1], "r", allow_unindexed=False) as bag:
    topics = {}
    for connection in bag._get_connections():
        types = genpy.dynamic.generate_dynamic(connection.datatype, connection.msg_def)
        topics[connection.topic] = {
            "type": connection.datatype, "stated": connection.md5sum,
            "md5": types[connection.datatype]._md5sum, "messages": 0,
        }
    for topic, message, time in bag.read_messages():
        known = topics[topic]
        known.setdefault("first", str(time.to_nsec()))
        known["messages"] += 1
        text = str(message)
        known["text"] = text if len(text) < 4000 else text[:2000] + "..." + text[-2000:]
    compression = bag.get_compression_info().compression
    print(json.dumps({"compression": compression, "topics": topics}))
