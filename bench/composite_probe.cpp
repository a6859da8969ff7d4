#include <chrono>
#include <cstdio>
#include <memory>
#include <random>
#include <cstdlib>
#include <algorithm>
#include "compositor/lane_table.hpp"
#include "compositor/window_kernel.hpp"
#include "datasets/transfer_functions.hpp"
using namespace tessera;
int main(int c,char**v){
  int rows=c>1?atoi(v[1]):28; std::size_t pixels=c>2?atoi(v[2]):16; double span=c>3?atof(v[3]):0.02;
  auto f=datasets::benchmark_transfer_function();
  projection::Lattice l{0,0x1p-30*2,0.5,0x1p-31};
  compositor::LaneTable table(f,l.scalar_origin,l.scalar_unit,l.depth_unit,scene::Emission::absorption);
  compositor::WindowRules rules{&table,0};
  auto state=std::make_unique<compositor::WindowState>();
  projection::SegmentWindows w; w.reset(pixels,32);
  std::mt19937 rng(1); std::uniform_real_distribution<double> u(0,1);
  struct P{std::size_t p; projection::LatticeSegment s;}; std::vector<P> list;
  for(std::size_t p=0;p<pixels;p++){ double s=u(rng)*0.8; for(int r=0;r<rows;r++){ double s2=std::clamp(s+span*(u(rng)-0.5)*2,0.0,1.0); int fr=(r*1000000+int(u(rng)*800000));
    list.push_back({p,{fr,fr+900000,compositor::lane_scalar(s,l.scalar_origin,l.scalar_unit),compositor::lane_scalar(s2,l.scalar_origin,l.scalar_unit)}}); s=s2; } }
  std::size_t half=0; scene::TraceLaps laps(nullptr);
  scene::Camera cam; 
  for(auto&x:state->open) x=-1; for(auto&x:state->length_per_step)x=1; state->transmittance.fill(1);state->red.fill(0);state->green.fill(0);state->blue.fill(0);state->optical_depth.fill(0);state->first_back.fill(0);state->back.fill(0);
  double best=1e9,bestf=1e9; 
  for(int k=0;k<200;k++){ auto t0=std::chrono::steady_clock::now(); int reps=20000/(rows*(int)pixels/16)+1; double tf=0,tc=0; std::uint64_t n=0;
   for(int i=0;i<reps;i++){ auto a=std::chrono::steady_clock::now(); for(auto&e:list) w.push(e.p,e.s); auto b=std::chrono::steady_clock::now(); n+=composite_windows(rules,w,0x7fffffff,*state,laps); auto d=std::chrono::steady_clock::now(); tf+=std::chrono::duration<double>(b-a).count(); tc+=std::chrono::duration<double>(d-b).count(); state->transmittance.fill(1);}
   best=std::min(best,tc/n); bestf=std::min(bestf,tf/n); (void)t0;(void)half;}
  printf("rows %d pixels %zu span %g: composite %.2f ns/seg, push %.2f\n",rows,pixels,span,best*1e9,bestf*1e9);
}
