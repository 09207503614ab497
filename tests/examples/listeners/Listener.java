// Prints each NAV_STATE, in Java. TYPES is the folder of the installed message types, share/maploop/lcm:
//   javac -cp /usr/share/java/lcm.jar:TYPES/java -d . Listener.java
//   java -Djava.net.preferIPv4Stack=true -cp /usr/share/java/lcm.jar:. Listener
import lcm.lcm.LCM;
import maploop_lcm.nav_state_t;

public class Listener {
  public static void main(String[] words) throws Exception {
    LCM lcm = new LCM();  // the default network, or that of LCM_DEFAULT_URL
    lcm.subscribe("NAV_STATE", (unused, channel, message) -> {
      try {
        nav_state_t s = new nav_state_t(message);
        System.out.printf("%.3f s: east %.2f m, north %.2f m, azimuth %.4f rad%n", s.header.stamp_ns * 1e-9,
            s.position_enu[0], s.position_enu[1], s.azimuth);
      } catch (java.io.IOException error) {
        System.err.println("a message of " + channel + " cannot be read: " + error.getMessage());
      }
    });
    Thread.currentThread().join();
  }
}
