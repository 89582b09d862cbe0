"""Which IMU a foot-worn stride estimate needs (Potter et al. 2019, Sensors 19(11):2601)."""
