#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <chrono>
#include <cstring>
#include "tests/gpu/05_rays.hpp"
#include "tests/gpu/harness.hpp"
using namespace welkin; using namespace welkin::test;
TEST_CASE("measure","[.][m]"){
  Random rnd(7); std::vector<SkyRay> rays; auto P=reference::earth();
  for(int i=0;i<200000;i++) rays.push_back(ray_from_degrees(i%3?rnd.log_uniform(1e-4,1e3):rnd.uniform(0,100), i%2?rnd.uniform(0,180):rnd.uniform(85,115), rnd.uniform(0,110), rnd.uniform(0,360)));
  for(int r=0;r<6;r++) for(auto s:{std::pair{1,1},{8,4},{32,8},{13,5},{64,16}}){ March m; m.rule=(Rule)r; m.view_steps=s.first;m.light_steps=s.second; m.albedo=.3; auto few=std::span(rays).first(64); march_rays(P,few,m); auto t0=std::chrono::steady_clock::now(); auto l=march_rays(P,rays,m); double dt=std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count(); uint64_t h=1469598103934665603ull; for(auto&x:l)for(int k=0;k<6;k++){ float f=k<3?x.radiance[k]:x.transmittance[k-3]; uint32_t b; memcpy(&b,&f,4); h=(h^b)*1099511628211ull;} fmt::print("rule {} {}x{} hash {:016x} {:.2f}s\n",r,s.first,s.second,h,dt);} }
